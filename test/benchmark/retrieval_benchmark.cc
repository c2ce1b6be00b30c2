// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Time to fill the index of places, to ask it and to empty it, and its memory,
// by the number of submaps. The submaps stand for those of many buildings, no
// two alike: each has half of the keypoints of two submaps of the maps that the
// environment variable CARTOGRAPHER_SDF_BENCHMARK_MAP names, each half in other
// dimensions and somewhat displaced. Without the variable, they are random:
// keypoints without structure, few votes for a pose.

#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "benchmark/benchmark.h"
#include "cartographer_sdf/matching/place_index.h"
#include "cartographer_sdf/place/place.h"
#include "test/benchmark/real_submaps.h"
#include "test/testing/feature_sets.h"

namespace cartographer_sdf {
namespace {

constexpr int kNumQueries = 64;

// How far keypoints are displaced at most, and their clearances [m], [rad].
struct Noise {
  double position;
  double clearance;
  double orientation;
};
constexpr Noise kNoiseOfBuilding{0.2, 0.1, 0.2};
constexpr Noise kNoiseOfView{0.05, 0.05, 0.1};

using Features = std::vector<Feature>;

const std::vector<Features>& RealFeatures() {
  static const auto& all = *[] {
    auto* const features = new std::vector<Features>();
    for (const OccupancyGrid& grid : benchmarks::RealSubmaps()) {
      std::optional<Place> place = DescribePlace({}, {}, grid);
      if (place) features->push_back(std::move(place->features.features));
    }
    return features;
  }();
  return all;
}

void Displace(const Noise& noise, std::mt19937* const engine,
              Feature* const feature) {
  const auto displaced = [engine](const double value, const double most) {
    return value + testing::Uniform(-most, most, engine);
  };
  Keypoint& keypoint = feature->keypoint;
  keypoint.position.x() = displaced(keypoint.position.x(), noise.position);
  keypoint.position.y() = displaced(keypoint.position.y(), noise.position);
  keypoint.clearance = displaced(keypoint.clearance, noise.clearance);
  feature->orientation =
      NormalizeAngle(displaced(feature->orientation, noise.orientation));
}

// Adds half of the features of a real submap, in other dimensions, turned and
// shifted.
void AddHalf(std::mt19937* const engine, FeatureSet* const set) {
  const std::vector<Features>& real = RealFeatures();
  const Features& features =
      real[testing::UniformInt(static_cast<int>(real.size()), engine)];
  const double scale = testing::Uniform(0.8, 1.25, engine);
  const Rigid2 T_new_old(
      {testing::Uniform(-5., 5., engine), testing::Uniform(-5., 5., engine)},
      testing::Uniform(-M_PI, M_PI, engine));
  for (Feature feature : features) {
    if (testing::UniformInt(2, engine) == 0) continue;
    feature.keypoint.position =
        T_new_old * Eigen::Vector2d(scale * feature.keypoint.position);
    feature.keypoint.clearance *= scale;
    feature.orientation += T_new_old.rotation();
    Displace(kNoiseOfBuilding, engine, &feature);
    set->features.push_back(feature);
  }
}

// The index does not look at descriptors, so there are none.
FeatureSet MakeSubmap(const int number) {
  std::mt19937 engine(static_cast<uint32_t>(number));
  if (RealFeatures().empty()) {
    return testing::RandomFeatures(200, 20., 1, &engine);
  }
  FeatureSet set;
  for (int half = 0; half < 2; ++half) AddHalf(&engine, &set);
  return set;
}

// The submap of that number as it is seen another time: turned, somewhat
// different, and one of four keypoints missing.
FeatureSet SeeAgain(const int number) {
  std::mt19937 engine(static_cast<uint32_t>(number) + 1000000000u);
  FeatureSet seen;
  for (Feature feature : MakeSubmap(number).features) {
    if (testing::UniformInt(4, &engine) == 0) continue;
    Displace(kNoiseOfView, &engine, &feature);
    seen.features.push_back(feature);
  }
  return testing::Moved(
      Rigid2({3., -2.}, testing::Uniform(-M_PI, M_PI, &engine)),
      std::move(seen));
}

// Seconds of work that are measured, without those of making submaps.
class Stopwatch {
 public:
  template <typename Work>
  void Time(const Work& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    seconds_ +=
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin)
            .count();
  }
  [[nodiscard]] double seconds() const { return seconds_; }

 private:
  double seconds_ = 0.;
};

// Returns the seconds that adding takes.
double AddAll(const int num_submaps, PlaceIndex* const index) {
  Stopwatch stopwatch;
  for (int k = 0; k < num_submaps; ++k) {
    const FeatureSet features = MakeSubmap(k);
    stopwatch.Time([&] { index->Add({0, k}, features); });
  }
  return stopwatch.seconds();
}

// The index of that many submaps. The one of another number is forgotten.
const PlaceIndex& IndexOf(const int num_submaps) {
  static std::unique_ptr<PlaceIndex> index;
  if (!index || index->size() != static_cast<size_t>(num_submaps)) {
    index = std::make_unique<PlaceIndex>(RetrievalOptions());
    AddAll(num_submaps, index.get());
  }
  return *index;
}

// The time is that of adding.
void BM_FillAndEmpty(benchmark::State& state) {
  const auto num_submaps = static_cast<int>(state.range(0));
  double bytes = 0.;
  double seconds_to_add = 0.;
  Stopwatch removing;
  for (auto _ : state) {
    PlaceIndex index{RetrievalOptions()};
    const double seconds = AddAll(num_submaps, &index);
    state.SetIterationTime(seconds);
    seconds_to_add += seconds;
    bytes = static_cast<double>(index.MemoryUse());
    removing.Time([&index, num_submaps] {
      for (int k = 0; k < num_submaps; ++k) index.Remove({0, k});
    });
  }
  state.SetComplexityN(num_submaps);
  const double num_treated =
      static_cast<double>(state.iterations()) * num_submaps;
  state.counters["us/add"] = 1e6 * seconds_to_add / num_treated;
  state.counters["us/remove"] = 1e6 * removing.seconds() / num_treated;
  state.counters["bytes/submap"] = bytes / num_submaps;
}
BENCHMARK(BM_FillAndEmpty)
    ->RangeMultiplier(10)
    ->Range(100, 100000)
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Complexity();

// Of submaps that are in the index, seen another time. `found`: the fraction of
// them that is the best candidate.
void BM_Query(benchmark::State& state) {
  const auto num_submaps = static_cast<int>(state.range(0));
  const PlaceIndex& index = IndexOf(num_submaps);
  std::vector<SubmapId> ids;
  std::vector<FeatureSet> queries;
  double num_found = 0.;
  double num_features = 0.;
  for (int k = 0; k < kNumQueries; ++k) {
    ids.push_back({0, k * (num_submaps / kNumQueries)});
    queries.push_back(SeeAgain(ids.back().index));
    const std::vector<RetrievalCandidate> best =
        index.QueryBest(queries.back(), 1);
    if (!best.empty() && best[0].id == ids.back()) ++num_found;
    num_features += static_cast<double>(queries.back().features.size());
  }
  size_t k = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(index.Query(queries[k++ % queries.size()]));
  }
  state.SetComplexityN(num_submaps);
  state.counters["found"] = num_found / kNumQueries;
  state.counters["features"] = num_features / kNumQueries;
}
BENCHMARK(BM_Query)
    ->RangeMultiplier(10)
    ->Range(100, 100000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();

}  // namespace
}  // namespace cartographer_sdf
