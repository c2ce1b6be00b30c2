// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pbstream/state_reader.h"

#include "absl/strings/str_cat.h"

namespace cartographer_sdf {
namespace {

// With and without histograms in submaps, which are of no use in 2D.
constexpr uint32_t kMinFormatVersion = 1;
constexpr uint32_t kMaxFormatVersion = 2;

}  // namespace

absl::StatusOr<StateReader> StateReader::Open(
    const std::string& path, const ProgressCallback& on_progress) {
  absl::StatusOr<RecordReader> records = RecordReader::Open(path);
  if (!records.ok()) return records.status();
  StateReader reader(*std::move(records));
  reader.on_progress_ = on_progress;
  const absl::StatusOr<bool> has_header = reader.records_.Read(&reader.record_);
  if (!has_header.ok()) return has_header.status();
  if (!*has_header) {
    return absl::DataLossError(
        absl::StrCat(path, " is truncated: it ends before its header"));
  }
  proto::SerializationHeader header;
  if (!header.ParseFromString(reader.record_)) {
    return reader.Corrupted("is no header");
  }
  if (header.format_version() < kMinFormatVersion ||
      header.format_version() > kMaxFormatVersion) {
    return absl::UnimplementedError(
        absl::StrCat(path, " has format version ", header.format_version(),
                     ", but only versions 1 and 2 are supported"));
  }
  reader.format_version_ = static_cast<int>(header.format_version());
  return reader;
}

absl::StatusOr<bool> StateReader::Next() {
  const absl::StatusOr<bool> has_record = records_.Read(&record_);
  if (!has_record.ok()) return has_record;
  if (on_progress_) {
    on_progress_(static_cast<double>(records_.position()) /
                 static_cast<double>(records_.size()));
  }
  if (!*has_record) return false;
  if (!data_.ParseFromString(record_)) {
    return Corrupted("is no valid protocol buffer");
  }
  return true;
}

std::string StateReader::kind() const {
  if (data_.data_case() == proto::SerializedData::DATA_NOT_SET) {
    return "unknown";
  }
  return proto::SerializedData::descriptor()
      ->FindFieldByNumber(data_.data_case())
      ->name();
}

}  // namespace cartographer_sdf
