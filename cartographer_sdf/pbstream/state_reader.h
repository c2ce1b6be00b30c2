// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_PBSTREAM_STATE_READER_H_
#define CARTOGRAPHER_SDF_PBSTREAM_STATE_READER_H_

#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "cartographer_sdf/execution/progress.h"
#include "cartographer_sdf/pbstream/record_stream.h"
#include "cartographer_sdf/serialized_state.pb.h"

namespace cartographer_sdf {

// The records of a .pbstream, one at a time: its header, then those behind it,
// decoded.
class StateReader {
 public:
  // Checks the header. `on_progress` may be empty.
  [[nodiscard]] static absl::StatusOr<StateReader> Open(
      const std::string& path, const ProgressCallback& on_progress);

  // Goes to the next record; false at the end of the file.
  [[nodiscard]] absl::StatusOr<bool> Next();

  // Of the current record.
  [[nodiscard]] const proto::SerializedData& data() const { return data_; }
  // Its bytes, and as the file has them; at first those of the header.
  [[nodiscard]] const std::string& record() const { return record_; }
  [[nodiscard]] const std::string& compressed() const {
    return records_.compressed();
  }
  // The field of SerializedData that it has, "unknown" for any other.
  [[nodiscard]] std::string kind() const;
  [[nodiscard]] absl::Status Corrupted(absl::string_view problem) const {
    return records_.Corrupted(problem);
  }

  [[nodiscard]] int format_version() const { return format_version_; }

 private:
  explicit StateReader(RecordReader records) : records_(std::move(records)) {}

  RecordReader records_;
  ProgressCallback on_progress_;
  int format_version_ = 0;
  std::string record_;
  proto::SerializedData data_;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PBSTREAM_STATE_READER_H_
