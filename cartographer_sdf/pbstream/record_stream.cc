// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pbstream/record_stream.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <limits>
#include <utility>

#include "absl/strings/str_cat.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

constexpr uint64_t kMagic = 0x7b1d1f7b5bf501db;
constexpr int kWordSize = 8;
// Size limit of protocol buffers.
constexpr int64_t kMaxRecordSize = std::numeric_limits<int32_t>::max();
constexpr int kChunkSize = 1 << 16;
// For zlib: the largest window, with gzip header and trailer.
constexpr int kGzipWindowBits = 15 + 16;

uint64_t DecodeWord(const std::array<char, kWordSize>& bytes) {
  uint64_t word = 0;
  for (int i = kWordSize - 1; i >= 0; --i) {
    word = word << 8 | static_cast<unsigned char>(bytes[i]);
  }
  return word;
}

std::string EncodeWord(uint64_t word) {
  std::string bytes;
  for (int i = 0; i < kWordSize; ++i) {
    bytes.push_back(static_cast<char>(word & 0xff));
    word >>= 8;
  }
  return bytes;
}

ZlibStream NewInflateStream() {
  ZlibStream stream(new z_stream(), [](z_stream* const stream) {
    inflateEnd(stream);
    delete stream;
  });
  CHECK_EQ(inflateInit2(stream.get(), kGzipWindowBits), Z_OK);
  return stream;
}

// The fastest level, as the host writes its files.
ZlibStream NewDeflateStream() {
  ZlibStream stream(new z_stream(), [](z_stream* const stream) {
    deflateEnd(stream);
    delete stream;
  });
  CHECK_EQ(deflateInit2(stream.get(), Z_BEST_SPEED, Z_DEFLATED, kGzipWindowBits,
                        /*memLevel=*/8, Z_DEFAULT_STRATEGY),
           Z_OK);
  return stream;
}

}  // namespace

RecordReader::RecordReader() : stream_(NewInflateStream()) {}

absl::StatusOr<RecordReader> RecordReader::Open(const std::string& path) {
  struct stat info = {};
  if (stat(path.c_str(), &info) != 0) {
    return absl::ErrnoToStatus(errno, absl::StrCat("cannot open ", path));
  }
  if (!S_ISREG(info.st_mode)) {
    return absl::InvalidArgumentError(
        absl::StrCat("cannot open ", path, ": not a regular file"));
  }
  RecordReader reader;
  reader.path_ = path;
  reader.size_ = info.st_size;
  errno = 0;
  reader.file_.open(path, std::ios::binary);
  if (!reader.file_) {
    return absl::ErrnoToStatus(errno == 0 ? EIO : errno,
                               absl::StrCat("cannot open ", path));
  }
  std::array<char, kWordSize> word;
  if (reader.size_ < kWordSize ||
      !reader.ReadBytes(kWordSize, word.data()).ok() ||
      DecodeWord(word) != kMagic) {
    return absl::InvalidArgumentError(absl::StrCat(
        path, " is not a .pbstream file (",
        reader.size_ == 0 ? "it is empty" : "bad magic number", ")"));
  }
  return reader;
}

absl::StatusOr<bool> RecordReader::Read(std::string* const record) {
  record->clear();
  const int64_t remaining = size_ - position_;
  if (remaining == 0) return false;
  if (remaining < kWordSize) {
    return absl::DataLossError(absl::StrCat(path_, " is truncated: ", remaining,
                                            " bytes after record ",
                                            num_records_, " are not a record"));
  }
  std::array<char, kWordSize> word;
  absl::Status status = ReadBytes(kWordSize, word.data());
  if (!status.ok()) return status;
  ++num_records_;
  const uint64_t length = DecodeWord(word);
  if (length > static_cast<uint64_t>(size_ - position_)) {
    return absl::DataLossError(absl::StrCat(
        path_, " is truncated: record ", num_records_, " has ", length,
        " bytes, but only ", size_ - position_, " are left in the file"));
  }
  status = Inflate(static_cast<int64_t>(length), record);
  if (!status.ok()) return status;
  return true;
}

absl::Status RecordReader::ReadBytes(const int64_t count, char* const bytes) {
  if (!file_.read(bytes, count)) {
    return absl::DataLossError(
        absl::StrCat("cannot read ", path_, " beyond byte ", position_));
  }
  position_ += count;
  return absl::OkStatus();
}

absl::Status RecordReader::Inflate(int64_t compressed_size,
                                   std::string* const record) {
  z_stream& stream = *stream_;
  CHECK_EQ(inflateReset(&stream), Z_OK);
  stream.avail_in = 0;
  compressed_.clear();
  std::array<char, kChunkSize> input;
  std::array<char, kChunkSize> output;
  int result = Z_OK;
  while (result == Z_OK) {
    if (stream.avail_in == 0 && compressed_size > 0) {
      const int64_t count = std::min<int64_t>(compressed_size, kChunkSize);
      const absl::Status status = ReadBytes(count, input.data());
      if (!status.ok()) return status;
      compressed_size -= count;
      compressed_.append(input.data(), static_cast<size_t>(count));
      stream.next_in = reinterpret_cast<Bytef*>(input.data());
      stream.avail_in = static_cast<uInt>(count);
    }
    stream.next_out = reinterpret_cast<Bytef*>(output.data());
    stream.avail_out = kChunkSize;
    result = inflate(&stream, Z_NO_FLUSH);
    const size_t produced = kChunkSize - stream.avail_out;
    if (static_cast<int64_t>(record->size() + produced) > kMaxRecordSize) {
      return Corrupted("is larger than 2 GiB");
    }
    record->append(output.data(), produced);
  }
  // Neither input nor output is left.
  if (result == Z_BUF_ERROR) return Corrupted("ends too early");
  if (result != Z_STREAM_END) {
    return Corrupted(absl::StrCat("is not valid gzip data (",
                                  stream.msg ? stream.msg : "no message", ")"));
  }
  if (stream.avail_in > 0 || compressed_size > 0) {
    return Corrupted("has bytes after the end of its gzip data");
  }
  return absl::OkStatus();
}

absl::Status RecordReader::Corrupted(const absl::string_view problem) const {
  return absl::DataLossError(absl::StrCat(path_, " is corrupted: record ",
                                          num_records_, " ", problem));
}

RecordWriter::RecordWriter() : stream_(NewDeflateStream()) {}

absl::StatusOr<RecordWriter> RecordWriter::Open(const std::string& path) {
  RecordWriter writer;
  writer.path_ = path;
  writer.target_path_ = path;
  std::error_code error;
  if (std::filesystem::is_symlink(path, error)) {
    const std::filesystem::path target =
        std::filesystem::weakly_canonical(path, error);
    if (!error) writer.target_path_ = target.string();
  }
  absl::Status status = writer.CreateTemporaryFile();
  if (!status.ok()) return status;
  status = writer.WriteBytes(EncodeWord(kMagic));
  if (!status.ok()) return status;
  return writer;
}

RecordWriter::RecordWriter(RecordWriter&& other) noexcept
    : path_(std::move(other.path_)),
      target_path_(std::move(other.target_path_)),
      temporary_path_(std::move(other.temporary_path_)),
      file_descriptor_(std::exchange(other.file_descriptor_, -1)),
      stream_(std::move(other.stream_)) {}

RecordWriter::~RecordWriter() {
  if (file_descriptor_ < 0) return;
  close(file_descriptor_);
  unlink(temporary_path_.c_str());
}

absl::Status RecordWriter::CreateTemporaryFile() {
  const std::string problem = absl::StrCat("cannot write ", path_);
  struct stat existing = {};
  const bool exists = stat(target_path_.c_str(), &existing) == 0;
  if (exists && !S_ISREG(existing.st_mode)) {
    return absl::InvalidArgumentError(
        absl::StrCat(problem, ": not a regular file"));
  }
  if (exists && access(target_path_.c_str(), W_OK) != 0) {
    return absl::ErrnoToStatus(errno, problem);
  }
  // Skips names of files left by another writer of this process or by a dead
  // process.
  constexpr int kMaxAttempts = 1000;
  for (int i = 0; i < kMaxAttempts; ++i) {
    temporary_path_ = absl::StrCat(target_path_, ".tmp-", getpid(), "-", i);
    file_descriptor_ = open(temporary_path_.c_str(),
                            O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file_descriptor_ >= 0 || errno != EEXIST) break;
  }
  if (file_descriptor_ < 0) return absl::ErrnoToStatus(errno, problem);
  if (exists && fchmod(file_descriptor_, existing.st_mode & 07777) != 0) {
    return absl::ErrnoToStatus(errno, problem);
  }
  return absl::OkStatus();
}

absl::Status RecordWriter::WriteBytes(const std::string& bytes) {
  size_t written = 0;
  while (written < bytes.size()) {
    const ssize_t count =
        write(file_descriptor_, bytes.data() + written, bytes.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      return absl::ErrnoToStatus(errno, absl::StrCat("cannot write ", path_));
    }
    written += static_cast<size_t>(count);
  }
  return absl::OkStatus();
}

// zlib's gzip header has no time stamp by default, so the output is
// deterministic.
std::string RecordWriter::Deflate(const std::string& record) {
  z_stream& stream = *stream_;
  CHECK_EQ(deflateReset(&stream), Z_OK);
  std::string compressed(deflateBound(&stream, record.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(record.data()));
  stream.avail_in = static_cast<uInt>(record.size());
  stream.next_out = reinterpret_cast<Bytef*>(compressed.data());
  stream.avail_out = static_cast<uInt>(compressed.size());
  CHECK_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  compressed.resize(stream.total_out);
  return compressed;
}

absl::Status RecordWriter::Write(const std::string& record) {
  CHECK_LE(static_cast<int64_t>(record.size()), kMaxRecordSize);
  return WriteCompressed(Deflate(record));
}

absl::Status RecordWriter::WriteCompressed(const std::string& member) {
  CHECK_GE(file_descriptor_, 0) << "written after Commit()";
  return WriteBytes(EncodeWord(member.size()) + member);
}

absl::Status RecordWriter::Commit() {
  CHECK_GE(file_descriptor_, 0) << "committed twice";
  const std::string problem = absl::StrCat("cannot write ", path_);
  // Without it, a crash of the machine could leave an empty file under the new
  // name.
  if (fsync(file_descriptor_) != 0 && errno != EINVAL) {
    return absl::ErrnoToStatus(errno, problem);
  }
  const bool closed = close(std::exchange(file_descriptor_, -1)) == 0;
  if (!closed || rename(temporary_path_.c_str(), target_path_.c_str()) != 0) {
    const absl::Status status = absl::ErrnoToStatus(errno, problem);
    unlink(temporary_path_.c_str());
    return status;
  }
  return absl::OkStatus();
}

}  // namespace cartographer_sdf
