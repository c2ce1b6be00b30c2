// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The record of a panorama file, behind its compression and checksum, and what
// localising a scan makes of it.

#include <cmath>
#include <string>
#include <vector>

#include "cartographer_sdf/localization/panorama_file.h"
#include "cartographer_sdf/pbstream/record_stream.h"
#include "glog/logging.h"
#include "test/fuzz/drawn_room.h"
#include "test/fuzz/fuzz_target.h"

namespace cartographer_sdf::fuzz {
namespace {

std::vector<std::string> RecordsOf(const std::string& path) {
  absl::StatusOr<RecordReader> reader = RecordReader::Open(path);
  CHECK(reader.ok()) << reader.status();
  std::vector<std::string> records;
  std::string record;
  while (*reader->Read(&record)) records.push_back(record);
  return records;
}

std::vector<std::string> RecordsOf(const DrawnMap& map) {
  const std::string path = Directory().File("panoramas.written");
  CHECK(WritePanoramas(path, PlaceFileKey(), map).ok());
  return RecordsOf(path);
}

const std::string& Header() {
  static const auto* const header = new std::string(RecordsOf(DrawRoom())[0]);
  return *header;
}

// Walls all round, nearer on one side.
RobotScan SomeScan() {
  Scan scan;
  for (int k = 0; k < 120; ++k) {
    const double angle = 2. * M_PI * k / 120.;
    const double range = 1.5 + 0.5 * std::cos(angle);
    scan.returns.emplace_back(range * std::cos(angle), range * std::sin(angle));
  }
  return {Rigid2(), scan};
}

}  // namespace

std::vector<std::string> Seeds() { return {RecordsOf(DrawRoom())[1]}; }

}  // namespace cartographer_sdf::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* const data,
                                      const size_t size) {
  using namespace cartographer_sdf;  // NOLINT
  const std::string path = fuzz::Directory().File("panoramas");
  absl::StatusOr<RecordWriter> writer = RecordWriter::Open(path);
  CHECK(writer.ok()) << writer.status();
  CHECK(writer->Write(fuzz::Header()).ok());
  CHECK(writer->Write(std::string(reinterpret_cast<const char*>(data), size))
            .ok());
  CHECK(writer->Commit().ok());
  const absl::StatusOr<DrawnMap> map = ReadPanoramas(path, PlaceFileKey());
  if (!map.ok()) {
    CHECK(!map.status().message().empty());
    return 0;
  }
  // Exactly what was read, once it is written by us.
  const std::vector<std::string> records = fuzz::RecordsOf(*map);
  const absl::StatusOr<DrawnMap> again = ReadPanoramas(
      fuzz::Directory().File("panoramas.written"), PlaceFileKey());
  CHECK(again.ok()) << again.status();
  CHECK(fuzz::RecordsOf(*again) == records);
  fuzz::CheckCandidates(LocalizeScans(ScanLocalizationOptions(), map->panoramas,
                                      {fuzz::SomeScan()}));
  return 0;
}
