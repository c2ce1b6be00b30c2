// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pbstream/record_stream.h"

#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/small_map.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::record_stream_test {
namespace {

using ::cartographer_sdf::testing::Container;
using ::cartographer_sdf::testing::Gzipped;
using ::cartographer_sdf::testing::LittleEndian;
using ::cartographer_sdf::testing::MagicNumber;
using ::cartographer_sdf::testing::ReadFile;
using ::cartographer_sdf::testing::ReadRecords;
using ::cartographer_sdf::testing::TemporaryDirectory;
using ::cartographer_sdf::testing::WriteFile;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

// Compressible and not, empty, and larger than any buffer on the way.
std::vector<std::string> SomeRecords() {
  std::string noise;
  uint32_t state = 42;
  for (int i = 0; i < 300'000; ++i) {
    state = state * 1664525u + 1013904223u;
    noise.push_back(static_cast<char>(state >> 24));
  }
  return {"first", "", noise, std::string(1'000'000, 'x'), "last"};
}

void Write(const std::string& path, const std::vector<std::string>& records) {
  absl::StatusOr<RecordWriter> writer = RecordWriter::Open(path);
  ASSERT_TRUE(writer.ok()) << writer.status();
  for (const std::string& record : records) {
    ASSERT_TRUE(writer->Write(record).ok());
  }
  const absl::Status status = writer->Commit();
  ASSERT_TRUE(status.ok()) << status;
}

// The message of the first error on the way through a file.
std::string ErrorOf(const std::string& path) {
  absl::StatusOr<RecordReader> reader = RecordReader::Open(path);
  if (!reader.ok()) return std::string(reader.status().message());
  while (true) {
    std::string record;
    const absl::StatusOr<bool> has_record = reader->Read(&record);
    if (!has_record.ok()) return std::string(has_record.status().message());
    if (!*has_record) return "";
  }
}

std::string ErrorOfBytes(const std::string& bytes) {
  const TemporaryDirectory directory;
  WriteFile(directory.File("a"), bytes);
  return ErrorOf(directory.File("a"));
}

std::vector<std::string> FilesIn(const std::string& directory) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    names.push_back(entry.path().filename().string());
  }
  return names;
}

TEST(RecordStreamTest, ReadsWhatAnotherWriterWrote) {
  const TemporaryDirectory directory;
  WriteFile(directory.File("a"), Container(SomeRecords()));
  EXPECT_THAT(ReadRecords(directory.File("a")),
              ElementsAreArray(SomeRecords()));
}

TEST(RecordStreamTest, ReadsWhatItWrote) {
  const TemporaryDirectory directory;
  Write(directory.File("a"), SomeRecords());
  EXPECT_THAT(ReadRecords(directory.File("a")),
              ElementsAreArray(SomeRecords()));
}

TEST(RecordStreamTest, HasTheLayoutOfTheHost) {
  const TemporaryDirectory directory;
  Write(directory.File("a"), {"x"});
  const std::string bytes = ReadFile(directory.File("a"));
  EXPECT_THAT(bytes, StartsWith("\xdb\x01\xf5\x5b\x7b\x1f\x1d\x7b"));
  EXPECT_EQ(bytes.substr(8, 8), LittleEndian(bytes.size() - 16));
  EXPECT_THAT(bytes.substr(16), StartsWith("\x1f\x8b"));
}

TEST(RecordStreamTest, SameRecordsGiveSameBytes) {
  const TemporaryDirectory directory;
  Write(directory.File("a"), SomeRecords());
  Write(directory.File("b"), SomeRecords());
  EXPECT_EQ(ReadFile(directory.File("a")), ReadFile(directory.File("b")));
  // The time stamp in the gzip header.
  EXPECT_EQ(ReadFile(directory.File("a")).substr(20, 4), std::string(4, '\0'));
}

TEST(RecordStreamTest, TellsWhereItIs) {
  const TemporaryDirectory directory;
  Write(directory.File("a"), {"first", "second"});
  absl::StatusOr<RecordReader> reader = RecordReader::Open(directory.File("a"));
  ASSERT_TRUE(reader.ok());
  const int64_t size =
      static_cast<int64_t>(ReadFile(directory.File("a")).size());
  EXPECT_EQ(reader->size(), size);
  EXPECT_EQ(reader->position(), 8);
  std::string record;
  ASSERT_TRUE(*reader->Read(&record));
  EXPECT_GT(reader->position(), 16);
  EXPECT_LT(reader->position(), size);
  ASSERT_TRUE(*reader->Read(&record));
  EXPECT_EQ(reader->position(), size);
  EXPECT_FALSE(*reader->Read(&record));
}

TEST(RecordStreamTest, SaysWhyItCannotOpen) {
  const TemporaryDirectory directory;
  EXPECT_EQ(ErrorOf(directory.File("a")), "cannot open " + directory.File("a") +
                                              ": No such file or directory");
  EXPECT_EQ(ErrorOf(directory.path()),
            "cannot open " + directory.path() + ": not a regular file");
  EXPECT_EQ(ErrorOf("/dev/zero"), "cannot open /dev/zero: not a regular file");
}

TEST(RecordStreamTest, RefusesForeignFiles) {
  EXPECT_THAT(ErrorOfBytes(""), EndsWith("not a .pbstream file (it is empty)"));
  EXPECT_THAT(ErrorOfBytes("\xdb\x01\xf5"),
              EndsWith("not a .pbstream file (bad magic number)"));
  EXPECT_THAT(ErrorOfBytes("P5 640 480 255 ......"),
              EndsWith("not a .pbstream file (bad magic number)"));
  EXPECT_THAT(ErrorOfBytes(Gzipped(MagicNumber())),
              EndsWith("(it is compressed as a whole: gunzip it first)"));
  EXPECT_EQ(ErrorOfBytes(MagicNumber()), "");
}

TEST(RecordStreamTest, NoticesEveryTruncation) {
  const std::string bytes = Container({"first", "second"});
  const size_t end_of_first = 16 + Gzipped("first").size();
  for (size_t size = MagicNumber().size() + 1; size < bytes.size(); ++size) {
    // Between records a file may end.
    if (size == end_of_first) continue;
    EXPECT_THAT(ErrorOfBytes(bytes.substr(0, size)), HasSubstr("is truncated"))
        << size;
  }
}

TEST(RecordStreamTest, NoticesEveryFlippedBit) {
  const TemporaryDirectory directory;
  const std::vector<std::string> records = {"first", "the second record"};
  const std::string bytes = Container(records);
  for (size_t i = 0; i < 8 * bytes.size(); ++i) {
    std::string flipped = bytes;
    flipped[i / 8] = static_cast<char>(flipped[i / 8] ^ 1 << i % 8);
    WriteFile(directory.File("a"), flipped);
    // Fields of the gzip header that say when and where it was written do not
    // matter.
    if (ErrorOf(directory.File("a")).empty()) {
      EXPECT_THAT(ReadRecords(directory.File("a")), ElementsAreArray(records));
    }
  }
}

TEST(RecordStreamTest, NamesTheCorruptedRecord) {
  std::string damaged = Gzipped("second");
  // In the checksum.
  damaged[damaged.size() - 6] =
      static_cast<char>(damaged[damaged.size() - 6] ^ 1);
  EXPECT_THAT(ErrorOfBytes(Container({"first"}) + LittleEndian(damaged.size()) +
                           damaged),
              HasSubstr("is corrupted: record 2 is not valid gzip data"));
  const std::string trailed = Gzipped("first") + "?";
  EXPECT_THAT(
      ErrorOfBytes(MagicNumber() + LittleEndian(trailed.size()) + trailed),
      HasSubstr("record 1 has bytes after the end"));
  const std::string cut = Gzipped("first").substr(0, 12);
  EXPECT_THAT(ErrorOfBytes(MagicNumber() + LittleEndian(cut.size()) + cut),
              HasSubstr("record 1 ends too early"));
  EXPECT_THAT(ErrorOfBytes(MagicNumber() + LittleEndian(0)),
              HasSubstr("record 1 ends too early"));
}

TEST(RecordStreamTest, DoesNotBelieveLengths) {
  for (const uint64_t length :
       {uint64_t{100}, uint64_t{1} << 40, uint64_t{1} << 63, ~uint64_t{0}}) {
    EXPECT_THAT(ErrorOfBytes(MagicNumber() + LittleEndian(length) + "abc"),
                HasSubstr("but only 3 are left in the file"));
  }
}

TEST(RecordStreamTest, NothingAppearsWithoutCommit) {
  const TemporaryDirectory directory;
  WriteFile(directory.File("a"), "old");
  {
    absl::StatusOr<RecordWriter> writer =
        RecordWriter::Open(directory.File("a"));
    ASSERT_TRUE(writer.ok());
    RecordWriter moved = *std::move(writer);
    ASSERT_TRUE(moved.Write("new").ok());
    EXPECT_EQ(FilesIn(directory.path()).size(), 2u);
  }
  EXPECT_THAT(FilesIn(directory.path()), ElementsAre("a"));
  EXPECT_EQ(ReadFile(directory.File("a")), "old");
}

TEST(RecordStreamTest, CommitLeavesOneFile) {
  const TemporaryDirectory directory;
  WriteFile(directory.File("a"), "old");
  Write(directory.File("a"), {"new"});
  EXPECT_THAT(FilesIn(directory.path()), ElementsAre("a"));
  EXPECT_THAT(ReadRecords(directory.File("a")), ElementsAre("new"));
}

TEST(RecordStreamTest, TwoWritersDoNotMeet) {
  const TemporaryDirectory directory;
  absl::StatusOr<RecordWriter> first = RecordWriter::Open(directory.File("a"));
  absl::StatusOr<RecordWriter> second = RecordWriter::Open(directory.File("a"));
  ASSERT_TRUE(first.ok() && second.ok());
  ASSERT_TRUE(first->Write("first").ok());
  ASSERT_TRUE(second->Write("second").ok());
  ASSERT_TRUE(second->Commit().ok());
  ASSERT_TRUE(first->Commit().ok());
  EXPECT_THAT(ReadRecords(directory.File("a")), ElementsAre("first"));
}

TEST(RecordStreamTest, KeepsLinksAndPermissions) {
  const TemporaryDirectory directory;
  WriteFile(directory.File("a"), "old");
  std::filesystem::permissions(
      directory.File("a"),
      std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  std::filesystem::create_symlink("a", directory.File("link"));
  Write(directory.File("link"), {"new"});
  EXPECT_TRUE(std::filesystem::is_symlink(directory.File("link")));
  EXPECT_THAT(ReadRecords(directory.File("a")), ElementsAre("new"));
  EXPECT_EQ(
      std::filesystem::status(directory.File("a")).permissions(),
      std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
}

// Stands for a full disk.
TEST(RecordStreamTest, NoticesThatWritingFails) {
  const TemporaryDirectory directory;
  WriteFile(directory.File("a"), "old");
  rlimit original = {};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &original), 0);
  const auto original_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit small = original;
  small.rlim_cur = 1000;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  absl::Status status;
  {
    absl::StatusOr<RecordWriter> writer =
        RecordWriter::Open(directory.File("a"));
    // Incompressible.
    if (writer.ok()) status = writer->Write(SomeRecords()[2]);
  }
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &original), 0);
  std::signal(SIGXFSZ, original_handler);
  EXPECT_EQ(std::string(status.message()),
            "cannot write " + directory.File("a") + ": File too large");
  EXPECT_THAT(FilesIn(directory.path()), ElementsAre("a"));
  EXPECT_EQ(ReadFile(directory.File("a")), "old");
}

TEST(RecordStreamTest, SaysWhyItCannotWrite) {
  const TemporaryDirectory directory;
  const auto error = [](const std::string& path) {
    return std::string(RecordWriter::Open(path).status().message());
  };
  EXPECT_EQ(error(directory.File("no/a")),
            "cannot write " + directory.File("no/a") +
                ": there is no directory " + directory.File("no"));
  EXPECT_EQ(error(directory.path()),
            "cannot write " + directory.path() + ": not a regular file");
  EXPECT_EQ(error("/dev/null"), "cannot write /dev/null: not a regular file");
  EXPECT_THAT(FilesIn(directory.path()), IsEmpty());
  if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  WriteFile(directory.File("a"), "old");
  std::filesystem::permissions(directory.File("a"),
                               std::filesystem::perms::owner_read);
  EXPECT_EQ(error(directory.File("a")),
            "cannot write " + directory.File("a") + ": Permission denied");
}

}  // namespace
}  // namespace cartographer_sdf::record_stream_test
