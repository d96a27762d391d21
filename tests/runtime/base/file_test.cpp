// Files whole or absent: with a full disk, a missing folder, an abandoned writer.
#include "runtime/base/file.h"

#include <doctest/doctest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "runtime/base/large.h"

namespace probe {
namespace {

namespace fs = std::filesystem;

struct Folder {
  fs::path path = fs::temp_directory_path() / ("probe_file_" + std::to_string(::getpid()));
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
  std::string file(const char* name) const { return (path / name).string(); }
  std::size_t entries() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(path), fs::directory_iterator()));
  }
};

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text));
}

TEST_CASE("a file is written whole, replaces the one before and leaves nothing beside it") {
  const Folder folder;
  REQUIRE(write_file(folder.file("a"), bytes_of("one")).ok());
  REQUIRE(write_file(folder.file("a"), bytes_of(std::string_view("t\0o", 3))).ok());
  CHECK(read_file(folder.file("a")).value() == std::string("t\0o", 3));
  CHECK(folder.entries() == 1);
  REQUIRE(write_file(folder.file("empty"), {}).ok());
  CHECK(read_file(folder.file("empty")).value().empty());
}

TEST_CASE("a writer that is given up leaves the old file and no other") {
  const Folder folder;
  REQUIRE(write_file(folder.file("a"), bytes_of("old")).ok());
  {
    const PendingFile pending(folder.file("a"));
    std::ofstream(pending.temporary()) << "half";
    CHECK(folder.entries() == 2);
  }
  CHECK(folder.entries() == 1);
  CHECK(read_file(folder.file("a")).value() == "old");
}

TEST_CASE("what cannot be written or read is a failure with the path") {
  const Folder folder;
  const std::string inside = folder.file("no/such/place");
  const Status status = write_file(inside, bytes_of("x"));
  REQUIRE_FALSE(status.ok());
  CHECK(status.failure().code == Fault::kIo);
  CHECK(to_text(status.failure()) == inside + ": cannot be created: No such file or directory");
  fs::create_directories(folder.file("folder/full"));
  CHECK_FALSE(write_file(folder.file("folder"), bytes_of("x")).ok());
  CHECK_FALSE(read_file(folder.file("folder")).ok());
  CHECK_FALSE(read_file(folder.file("nothing")).ok());
  CHECK(folder.entries() == 1);
  PendingFile never(folder.file("b"));
  CHECK_FALSE(never.keep().ok());
}

TEST_CASE("a pipe, a device or a folder in the place of a file stays what it is") {
  const Folder folder;
  REQUIRE(::mkfifo(folder.file("pipe").c_str(), 0600) == 0);
  const Status status = write_file(folder.file("pipe"), bytes_of("x"));
  REQUIRE_FALSE(status.ok());
  CHECK(to_text(status.failure()) ==
        folder.file("pipe") + ": is a folder, a device or a pipe and is not replaced");
  CHECK(fs::is_fifo(folder.file("pipe")));
  CHECK(folder.entries() == 1);
}

TEST_CASE("only a regular file is read, and a pipe is not waited for") {
  const Folder folder;
  REQUIRE(::mkfifo(folder.file("pipe").c_str(), 0600) == 0);
  for (const std::string& path :
       {folder.file("pipe"), std::string("/dev/zero"), folder.file(".")}) {
    const auto read = read_file(path);
    REQUIRE_FALSE(read.ok());
    CHECK(to_text(read.failure()) == path + ": is no file but a folder, a device or a pipe");
  }
  const auto absent = read_file(folder.file("absent"), {.code = Fault::kAsset});
  CHECK(absent.failure().code == Fault::kAsset);
  CHECK(to_text(absent.failure()) == folder.file("absent") + ": there is no such file");
  CHECK(read_file(folder.file("pipe/below")).failure().message ==
        "cannot be opened: Not a directory");
}

TEST_CASE("a file with more bytes than its reader wants is refused by its size") {
  const Folder folder;
  REQUIRE(write_file(folder.file("a"), bytes_of("12345")).ok());
  CHECK(read_file(folder.file("a"), {.most = 5}).value() == "12345");
  const auto read = read_file(folder.file("a"), {.most = 4});
  REQUIRE_FALSE(read.ok());
  CHECK(read.failure().message == "has more than the 4 bytes that are read" + large_hint());
  // A hole takes no memory.
  fs::resize_file(folder.file("a"), std::uintmax_t{1} << 40);
  CHECK(read_file(folder.file("a"), {.most = std::size_t{3} << 20}).failure().message ==
        "has more than the 3 MiB that are read" + large_hint());
  // The kernel says 0 bytes of its own files and gives what it has.
  CHECK(read_file("/proc/self/status")->starts_with("Name:"));
  CHECK_FALSE(read_file("/proc/self/status", {.most = 10}).ok());
}

TEST_CASE("a file behind a symbolic link is written where the link leads") {
  const Folder folder;
  fs::create_directories(folder.file("there"));
  fs::create_symlink("there/a", folder.file("link"));
  REQUIRE(write_file(folder.file("link"), bytes_of("first")).ok());
  REQUIRE(write_file(folder.file("link"), bytes_of("second")).ok());
  CHECK(fs::is_symlink(folder.file("link")));
  CHECK(read_file(folder.file("there/a")).value() == "second");
}

}  // namespace
}  // namespace probe
