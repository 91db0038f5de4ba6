// Files written whole or not at all, their sums, and the matchers that the tests of the data room use.
#include "base/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "base/sha256.hpp"
#include "tests/support/data/small_dataset.hpp"
#include "tests/support/data_error.hpp"
#include "tests/support/run_process.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using testing::data_error;
using testing::everything_in;
using testing::says;
using testing::TemporaryFolder;

// No file of this process grows beyond so many bytes, until the end of the object.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    open_standard_descriptors();  // the signal becomes an error
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() { ::setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

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

TEST(FileIo, ReadsNoMoreThanTheLimit) {
  const TemporaryFolder folder;
  const std::string file = folder.file("ten", "0123456789");
  EXPECT_EQ(read_file(file, 10), "0123456789");
  EXPECT_EQ(data_error([&] { read_file(file, 9); }), file + ": found 10 bytes, expected at most 9");
  // Whose size is not stated.
  const std::string message = data_error([&] { read_file("/proc/self/status", 20); });
  EXPECT_TRUE(says(message, {"/proc/self/status: found ", " bytes, expected at most 20"}));
  EXPECT_EQ(read_file(folder.file("empty", ""), 0), "");
  EXPECT_EQ(data_error([&] { read_file(folder / "none"); }),
            (folder / "none").string() + ": cannot be read: No such file or directory");
}

TEST(FileIo, OnlyRegularFilesAreRead) {
  const TemporaryFolder folder;
  const std::string pipe = (folder / "pipe").string(), socket = (folder / "socket").string();
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  ASSERT_LT(socket.size(), sizeof address.sun_path);
  socket.copy(address.sun_path, socket.size());
  const int s = ::socket(AF_UNIX, SOCK_STREAM, 0);
  ASSERT_EQ(::bind(s, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  EXPECT_EQ(data_error([&] { read_file(pipe); }), pipe + ": found a pipe, expected a regular file");
  EXPECT_EQ(data_error([&] { read_file(socket); }), socket + ": found a socket, expected a regular file");
  EXPECT_EQ(data_error([] { read_file("/dev/null"); }), "/dev/null: found a device, expected a regular file");
  EXPECT_EQ(data_error([&] { read_file(folder.path()); }),
            folder.path().string() + ": cannot be read: Is a directory");
  ::close(s);
  fs::create_symlink(folder.file("file", "text"), folder / "link");
  EXPECT_EQ(read_file(folder / "link"), "text");
  EXPECT_EQ(kind_of_file(folder / "link"), "a link");
  EXPECT_EQ(kind_of_file(folder / "file"), "a regular file");
  EXPECT_EQ(kind_of_file(folder.path()), "a folder");
}

TEST(FileIo, FilesThatAreThereAreRefusedOnRequest) {
  const TemporaryFolder folder;
  const std::string file = folder.file("file", "old");
  const std::string wanted = file + ": it exists; choose another name or give --overwrite";
  EXPECT_EQ(testing::usage_error([&] { require_writable(file, Existing::Refuse); }), wanted);
  EXPECT_EQ(testing::usage_error([&] { require_writable(file, Existing::Refuse, "--out"); }),
            "--out=" + wanted);
  EXPECT_EQ(testing::usage_error([&] { write_file(file, "new", Existing::Refuse); }), wanted);
  EXPECT_EQ(read_file(file), "old");
  EXPECT_NO_THROW(require_writable(file, Existing::Replace));
  EXPECT_NO_THROW(require_writable(folder / "new", Existing::Refuse));
  EXPECT_EQ(data_error([&] { require_writable(folder.path(), Existing::Replace); }),
            folder.path().string() + ": cannot be written: Is a directory");
  // It came between being added and being written.
  FileTransaction files(Existing::Refuse);
  files.add(folder / "late", "mine");
  EXPECT_EQ(files.targets(), std::vector<fs::path>{folder / "late"});
  folder.file("late", "theirs");
  EXPECT_NE(testing::usage_error([&] { files.commit(); }), "");
  EXPECT_EQ(read_file(folder / "late"), "theirs");
}

TEST(FileIo, FoldersThatAreLinksAreNotOurs) {
  const TemporaryFolder folder;
  fs::create_directory_symlink(folder.path(), folder / "link");
  EXPECT_EQ(testing::usage_error([&] { require_own_folder(folder / "link"); }),
            (folder / "link").string() + ": found a link, expected a folder or none");
  EXPECT_NO_THROW(require_own_folder(folder.path()));
  EXPECT_NO_THROW(require_own_folder(folder / "none"));
}

// The name of the second temporary file is taken away, so that its renaming fails when the first was renamed.
TEST(FileIo, AFailedCommitBringsTheOldFilesBack) {
  for (const bool first_is_new : {false, true}) {
    const TemporaryFolder folder;
    if (!first_is_new) folder.file("one", "old");
    {
      FileTransaction files;
      files.add(folder / "one", "new");
      files.add(folder / "deep/two", "new");
      fs::remove(folder / fmt::format("deep/two.tmp-{}-0", ::getpid()));
      EXPECT_EQ(data_error([&] { files.commit(); }),
                (folder / "deep/two").string() + ": cannot be written: No such file or directory");
    }
    if (!first_is_new) {
      EXPECT_EQ(read_file(folder / "one"), "old");
      fs::remove(folder / "one");
    }
    EXPECT_TRUE(everything_in(folder.path()).empty());
  }
}

TEST(FileIo, FilesOfOthersUnderTemporaryNamesStay) {
  const TemporaryFolder folder;
  const std::string taken = folder.file(fmt::format("file.tmp-{}-0", ::getpid()), "theirs");
  write_file(folder / "file", "mine");
  EXPECT_EQ(read_file(folder / "file"), "mine");
  EXPECT_EQ(read_file(taken), "theirs");
  EXPECT_EQ(everything_in(folder.path()).size(), 2u);
}

TEST(FileIo, AFullDiscLeavesTheOldFile) {
  const TemporaryFolder folder;
  write_file(folder / "file", "old");
  {
    const FileSizeLimit limit(1000);
    EXPECT_EQ(data_error([&] { write_file(folder / "file", std::string(1001, 'x')); }),
              (folder / "file").string() + ": cannot be written: File too large");
    EXPECT_EQ(read_file(folder / "file"), "old");
    write_file(folder / "file", std::string(1000, 'x'));
  }
  EXPECT_EQ(read_file(folder / "file"), std::string(1000, 'x'));
  EXPECT_EQ(everything_in(folder.path()), std::vector<std::string>{"file"});
}

TEST(FileIo, ClosedStandardDescriptorsAreTaken) {
  const auto closed_and_taken = [] {
    for (int fd = 0; fd <= 2; ++fd) ::close(fd);
    open_standard_descriptors();
    char byte = 0;
    bool good = ::read(0, &byte, 1) == 0;
    for (const int fd : {1, 2}) good = good && ::write(fd, &byte, 1) == -1 && errno == EBADF;
    return good && ::open("/dev/null", O_RDONLY) > 2 ? 0 : 1;
  };
  EXPECT_EXIT(::_exit(closed_and_taken()), ::testing::ExitedWithCode(0), "");
}

TEST(FileIo, OpenStandardDescriptorsStay) {
  const TemporaryFolder folder;
  const auto kept = [&] {
    ::close(0);
    bool good = ::open(folder.file("input", "x").c_str(), O_RDONLY) == 0;
    open_standard_descriptors();
    char byte = 0;
    good = good && ::read(0, &byte, 1) == 1 && byte == 'x';
    return good ? 0 : 1;
  };
  EXPECT_EXIT(::_exit(kept()), ::testing::ExitedWithCode(0), "");
}

// Locks belong to the open file, so that a process can be its own neighbour.
TEST(FileLocks, TheSecondWaitsAndThenSaysWhoHasIt) {
  const TemporaryFolder folder;
  const std::string file = folder.file("place", "");
  const int one = ::open(file.c_str(), O_RDONLY), other = ::open(file.c_str(), O_RDONLY);
  lock_place(one, file, milliseconds(0));
  lock_place(one, file, milliseconds(0));  // its own already
  lock_place(-1, file, milliseconds(0));   // what cannot be locked is left without
  const auto begin = std::chrono::steady_clock::now();
  const std::string message = testing::usage_error([&] { lock_place(other, file, milliseconds(50)); });
  EXPECT_GE(std::chrono::steady_clock::now() - begin, milliseconds(50));
  const bool listed =
      testing::content("/proc/locks").find(fmt::format(" {} ", ::getpid())) != std::string::npos;
  const std::string holder = listed ? fmt::format("process {}", ::getpid()) : "another process";
  EXPECT_EQ(message, file + ": " + holder + " is writing there");
  std::thread release([&] {
    std::this_thread::sleep_for(milliseconds(30));
    ::close(one);
  });
  lock_place(other, file, milliseconds(20000));
  release.join();
  ::close(other);
}

TEST(FileLocks, ACommitWaitsForAnother) {
  const TemporaryFolder folder;
  const int other = ::open(folder.path().c_str(), O_RDONLY | O_DIRECTORY);
  lock_place(other, folder.path(), milliseconds(0));
  std::thread release([&] {
    std::this_thread::sleep_for(milliseconds(30));
    EXPECT_FALSE(fs::exists(folder / "file"));
    ::close(other);
  });
  write_file(folder / "file", "text");
  release.join();
  EXPECT_EQ(read_file(folder / "file"), "text");
}

TEST(LineFiles, AreOnDiscLineByLine) {
  const TemporaryFolder folder;
  const fs::path path = folder / "deep/er/lines";
  {
    LineFile file(path, Existing::Refuse);
    EXPECT_EQ(file.path(), path);
    file.append("one");
    EXPECT_EQ(read_file(path), "one\n");
    file.append("");
    EXPECT_EQ(read_file(path), "one\n\n");
    file.replace("head\n");
    EXPECT_EQ(read_file(path), "head\n");
    file.append("two");
    // Locked still, under the new file of that name.
    EXPECT_TRUE(says(testing::usage_error([&] { LineFile(path, Existing::Replace); }), {"is writing there"}));
  }
  EXPECT_EQ(read_file(path), "head\ntwo\n");
  EXPECT_EQ(everything_in(folder.path()), (std::vector<std::string>{"deep", "er", "lines"}));
  EXPECT_EQ(testing::usage_error([&] { LineFile(path, Existing::Refuse); }),
            path.string() + ": it exists; choose another name or give --overwrite");
  EXPECT_EQ(read_file(path), "head\ntwo\n");
  LineFile(path, Existing::Replace).append("new");
  EXPECT_EQ(read_file(path), "new\n");
}

TEST(LineFiles, OnlyWhatItMadeIsRemovedWhenEmpty) {
  const TemporaryFolder folder;
  { const LineFile file(folder / "deep/er/lines", Existing::Refuse); }
  EXPECT_TRUE(everything_in(folder.path()).empty());
  folder.file("older", "lines\n");
  { const LineFile file(folder / "older", Existing::Replace); }
  EXPECT_EQ(read_file(folder / "older"), "");
}

TEST(LineFiles, RefuseWhatIsNoFile) {
  const TemporaryFolder folder;
  const std::string file = folder.file("file", "text");
  EXPECT_TRUE(says(testing::usage_error([&] { LineFile(folder / "file/deep/lines", Existing::Replace); }),
                   {file + "/deep: folder cannot be created: Not a directory"}));
  fs::create_symlink(file, folder / "link");
  EXPECT_TRUE(says(testing::usage_error([&] { LineFile(folder / "link", Existing::Replace); }),
                   {"link: found a link"}));
  EXPECT_EQ(data_error([&] { LineFile(folder.path(), Existing::Replace); }),
            folder.path().string() + ": cannot be written: Is a directory");
  EXPECT_TRUE(says(testing::usage_error([&] { LineFile("/proc/self/lines", Existing::Refuse); }),
                   {"/proc/self/lines: cannot be written: "}));
  EXPECT_EQ(read_file(file), "text");
  EXPECT_EQ(everything_in(folder.path()), (std::vector<std::string>{"file", "link"}));
}

// A part of a line is taken back.
TEST(LineFiles, AFullDiscLeavesWholeLines) {
  const TemporaryFolder folder;
  const std::string path = (folder / "lines").string(), failed = path + ": cannot append a record: ";
  LineFile file(path, Existing::Refuse);
  file.append("0123456");
  const FileSizeLimit limit(10);
  EXPECT_EQ(data_error([&] { file.append("abc"); }), failed + "the disc is full");
  EXPECT_EQ(read_file(path), "0123456\n");
  file.append("a");  // 10 bytes now
  EXPECT_EQ(data_error([&] { file.append(""); }), failed + "File too large");
  EXPECT_EQ(data_error([&] { file.replace("0123456789ab"); }), path + ": cannot be written: File too large");
  EXPECT_EQ(read_file(path), "0123456\na\n");
  EXPECT_EQ(everything_in(folder.path()), std::vector<std::string>{"lines"});
}

}  // namespace
}  // namespace odobench
