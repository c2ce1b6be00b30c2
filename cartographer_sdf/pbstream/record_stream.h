// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The container of a .pbstream: an 8-byte magic number, then records, each an
// 8-byte little-endian length and a gzip member of that length. Records are
// passed on decompressed but not decoded.

#ifndef CARTOGRAPHER_SDF_PBSTREAM_RECORD_STREAM_H_
#define CARTOGRAPHER_SDF_PBSTREAM_RECORD_STREAM_H_

#include <cstdint>
#include <fstream>
#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

// zlib's z_stream.
struct z_stream_s;

namespace cartographer_sdf {

// Created once per file: most records are tiny, and a stream is not.
using ZlibStream = std::unique_ptr<z_stream_s, void (*)(z_stream_s*)>;

class RecordReader {
 public:
  // Checks the magic number. Errors name the path.
  [[nodiscard]] static absl::StatusOr<RecordReader> Open(
      const std::string& path);

  // Reads the next record; false at the end of the file, an error if the file
  // is truncated or corrupted. Memory grows with the decompressed size, not
  // with the length that a record claims.
  [[nodiscard]] absl::StatusOr<bool> Read(std::string* record);
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
  [[nodiscard]] absl::Status Inflate(int64_t compressed_size,
                                     std::string* record);

  std::string path_;
  std::ifstream file_;
  ZlibStream stream_;
  std::string compressed_;
  int64_t position_ = 0;
  int64_t size_ = 0;
  int num_records_ = 0;
};

// Writes to a temporary file beside `path`; Commit() renames it. Without a
// commit, the destructor leaves nothing behind. The same records give the same
// bytes.
class RecordWriter {
 public:
  // Fails if the target cannot be replaced: a directory, a device, a
  // write-protected file. Follows symbolic links.
  [[nodiscard]] static absl::StatusOr<RecordWriter> Open(
      const std::string& path);
  RecordWriter(RecordWriter&& other) noexcept;
  RecordWriter& operator=(RecordWriter&&) = delete;
  ~RecordWriter();

  // After an error or Commit(), the writer must not be used any more.
  [[nodiscard]] absl::Status Write(const std::string& record);
  // Writes a record from RecordReader::compressed() without compressing it
  // again.
  [[nodiscard]] absl::Status WriteCompressed(const std::string& member);
  [[nodiscard]] absl::Status Commit();

 private:
  RecordWriter();

  [[nodiscard]] absl::Status CreateTemporaryFile();
  [[nodiscard]] absl::Status WriteBytes(const std::string& bytes);
  [[nodiscard]] std::string Deflate(const std::string& record);

  // The path as given, for messages, and the path with links resolved.
  std::string path_;
  std::string target_path_;
  std::string temporary_path_;
  int file_descriptor_ = -1;
  ZlibStream stream_;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PBSTREAM_RECORD_STREAM_H_
