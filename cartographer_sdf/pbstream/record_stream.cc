// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pbstream/record_stream.h"

#include <sys/stat.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include "absl/strings/str_cat.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

constexpr uint64_t kMagic = 0x7b1d1f7b5bf501db;
constexpr uint64_t kGzipMagic = 0x8b1f;
constexpr int kWordSize = 8;
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
  std::array<char, kWordSize> word{};
  if (reader.size_ < kWordSize ||
      !reader.ReadBytes(kWordSize, word.data()).ok() ||
      DecodeWord(word) != kMagic) {
    const bool is_gzip = (DecodeWord(word) & 0xffff) == kGzipMagic;
    return absl::InvalidArgumentError(
        absl::StrCat(path, " is not a .pbstream file (",
                     reader.size_ == 0 ? "it is empty"
                     : is_gzip ? "it is compressed as a whole: gunzip it first"
                               : "bad magic number",
                     ")"));
  }
  return reader;
}

absl::StatusOr<bool> RecordReader::Read(std::string* const record,
                                        const int64_t max_size) {
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
  status = Inflate(static_cast<int64_t>(length), max_size, record);
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
                                   const int64_t max_size,
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
    record->append(output.data(), kChunkSize - stream.avail_out);
    if (static_cast<int64_t>(record->size()) > max_size) {
      return Corrupted(
          absl::StrCat("is larger than ", (max_size >> 20) + 1, " MiB"));
    }
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

RecordWriter::RecordWriter(PendingFile file)
    : file_(std::move(file)), stream_(NewDeflateStream()) {}

absl::StatusOr<RecordWriter> RecordWriter::Open(const std::string& path) {
  absl::StatusOr<PendingFile> file = PendingFile::Create(path);
  if (!file.ok()) return file.status();
  const absl::Status status = file->Write(EncodeWord(kMagic));
  if (!status.ok()) return status;
  return RecordWriter(*std::move(file));
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
  const absl::Status status = file_.Write(EncodeWord(member.size()));
  return status.ok() ? file_.Write(member) : status;
}

absl::Status RecordWriter::Commit() { return file_.Commit(); }

bool HasMagicNumber(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, kWordSize> word;
  return file.read(word.data(), kWordSize) && DecodeWord(word) == kMagic;
}

}  // namespace cartographer_sdf
