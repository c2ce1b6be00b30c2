// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The container of a .pbstream: an 8-byte magic number, then records, each an
// 8-byte little-endian length and a gzip member of that length. Records are
// passed on decompressed but not decoded.

#ifndef CARTOGRAPHER_SDF_PBSTREAM_RECORD_STREAM_H_
#define CARTOGRAPHER_SDF_PBSTREAM_RECORD_STREAM_H_

#include <cstdint>
#include <fstream>
#include <limits>
#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "cartographer_sdf/file/pending_file.h"

// zlib's z_stream.
struct z_stream_s;

namespace cartographer_sdf {

// Created once per file: most records are tiny, and a stream is not.
using ZlibStream = std::unique_ptr<z_stream_s, void (*)(z_stream_s*)>;

// The size limit of protocol buffers.
constexpr int64_t kMaxRecordSize = std::numeric_limits<int32_t>::max();

class RecordReader {
 public:
  // Checks the magic number. Errors name the path.
  [[nodiscard]] static absl::StatusOr<RecordReader> Open(
      const std::string& path);

  // Reads the next record; false at the end of the file, an error if the file
  // is truncated or corrupted. Memory grows with the decompressed size, not
  // with the length that a record claims, up to `max_size`; what is larger is
  // an error, too.
  [[nodiscard]] absl::StatusOr<bool> Read(std::string* record,
                                          int64_t max_size = kMaxRecordSize);
  // The last record read, as in the file: its gzip member.
  [[nodiscard]] const std::string& compressed() const { return compressed_; }

  // Bytes read and size of the file.
  [[nodiscard]] int64_t position() const { return position_; }
  [[nodiscard]] int64_t size() const { return size_; }
  [[nodiscard]] const std::string& path() const { return path_; }
  // Returns an error about the last record read, counted from 1: "PATH is
  // corrupted: record 17 PROBLEM".
  [[nodiscard]] absl::Status Corrupted(absl::string_view problem) const;

 private:
  RecordReader();

  [[nodiscard]] absl::Status ReadBytes(int64_t count, char* bytes);
  [[nodiscard]] absl::Status Inflate(int64_t compressed_size, int64_t max_size,
                                     std::string* record);

  std::string path_;
  std::ifstream file_;
  ZlibStream stream_;
  std::string compressed_;
  int64_t position_ = 0;
  int64_t size_ = 0;
  int num_records_ = 0;
};

// Writes a PendingFile: the path has the old content or all of the new one. The
// same records give the same bytes.
class RecordWriter {
 public:
  // Fails if the target cannot be replaced, see PendingFile.
  [[nodiscard]] static absl::StatusOr<RecordWriter> Open(
      const std::string& path);

  // After an error or Commit(), the writer must not be used any more.
  [[nodiscard]] absl::Status Write(const std::string& record);
  // Writes a record from RecordReader::compressed() without compressing it
  // again.
  [[nodiscard]] absl::Status WriteCompressed(const std::string& member);
  [[nodiscard]] absl::Status Commit();

  [[nodiscard]] const std::string& path() const { return file_.path(); }
  // What has been written, until it is committed.
  [[nodiscard]] const std::string& temporary_path() const {
    return file_.temporary_path();
  }

 private:
  explicit RecordWriter(PendingFile file);

  [[nodiscard]] std::string Deflate(const std::string& record);

  PendingFile file_;
  ZlibStream stream_;
};

// Whether a file begins like a .pbstream; false if it cannot be read.
[[nodiscard]] bool HasMagicNumber(const std::string& path);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PBSTREAM_RECORD_STREAM_H_
