// Files written whole or not at all, their sums, and the matchers that the tests of the data room use.
#include "base/files.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "base/sha256.hpp"
#include "tests/support/data_error.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/small_dataset.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;
using testing::everything_in;
using testing::says;
using testing::TemporaryFolder;

TEST(FileIo, WritesWholeFilesAndCreatesFolders) {
  const TemporaryFolder folder;
  const std::string bytes("a\0b\r\n", 5);
  write_file(folder / "deep/er/file", bytes);
  EXPECT_EQ(read_file(folder / "deep/er/file"), bytes);
  write_file(folder / "deep/er/file", "");
  EXPECT_EQ(read_file(folder / "deep/er/file"), "");
  EXPECT_EQ(everything_in(folder.path()), (std::vector<std::string>{"deep", "er", "file"}));
  EXPECT_GT(read_file("/proc/self/status").size(), 100u);  // states a size of 0
}

TEST(FileIo, AnAbandonedTransactionLeavesNothing) {
  const TemporaryFolder folder;
  {
    FileTransaction files;
    files.add(folder / "a/one", "1");
    files.add(folder / "two", "2");
    EXPECT_FALSE(fs::exists(folder / "a/one"));
  }
  EXPECT_TRUE(everything_in(folder.path()).empty());
}

TEST(FileIo, AppendedPiecesAppearTogether) {
  const TemporaryFolder folder;
  const std::string one(100000, 'a'), two(70000, 'b');
  {
    FileTransaction files;
    files.add(folder / "long", "head ");
    files.append(one);
    EXPECT_FALSE(fs::exists(folder / "long"));
    files.append(two);
    files.commit();
  }
  EXPECT_EQ(read_file(folder / "long"), "head " + one + two);
  EXPECT_EQ(everything_in(folder.path()), std::vector<std::string>{"long"});
  std::string pieces;
  read_pieces(folder / "long", 4096, [&](std::string_view piece) {
    EXPECT_LE(piece.size(), 4096u);
    pieces += piece;
  });
  EXPECT_EQ(pieces, "head " + one + two);
  EXPECT_EQ(sha256_of_file(folder / "long"), sha256(pieces));
}

TEST(Sha256, StandardVectors) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  const TemporaryFolder folder;
  EXPECT_EQ(sha256_of_file(folder.file("abc", "abc")), sha256("abc"));
  EXPECT_FALSE(is_sha256(std::string(63, 'a')));
  EXPECT_FALSE(is_sha256(std::string(64, 'A')));
  EXPECT_TRUE(is_sha256(std::string(64, 'a')));
}

TEST(DataErrorMatchers, CanFail) {
  EXPECT_FALSE(says("", {}));
  EXPECT_FALSE(says("two\nlines", {}));
  EXPECT_FALSE(says("one line", {"two"}));
  EXPECT_TRUE(says("one line", {"one", "line"}));
}

// A rename over a device, a pipe or a link would destroy what is none of ours.
TEST(FileIo, OnlyRegularFilesAreReplaced) {
  const testing::TemporaryFolder folder;
  const std::string pipe = (folder / "pipe").string(), link = (folder / "link").string();
  const std::string behind = folder.file("behind", "kept");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::filesystem::create_symlink(behind, link);
  std::filesystem::create_symlink(folder / "nowhere", folder / "dangling");
  for (const std::string& target : {pipe, link, (folder / "dangling").string()}) {
    try {
      write_file(target, "new");
      FAIL() << target << " was written";
    } catch (const std::invalid_argument& e) {
      EXPECT_NE(std::string(e.what()).find("expected a regular file or a new name"), std::string::npos)
          << e.what();
    }
  }
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_EQ(read_file(behind), "kept");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 4);
}

}  // namespace
}  // namespace odobench
