#include "runtime/base/file_stream.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>

#include "runtime/base/file.h"

namespace probe {

TEST_CASE("a file that is written from beginning to end holds its pieces in their order") {
  const std::string path =
      (std::filesystem::temp_directory_path() / ("file_stream_test_" + std::to_string(::getpid())))
          .string();
  auto file = FileStream::create(path);
  REQUIRE(file.ok());
  CHECK(file->write("one, ").ok());
  CHECK(file->write("two").ok());
  CHECK(file->finish().ok());
  const auto read = read_file(path);
  REQUIRE(read.ok());
  CHECK(*read == "one, two");
  std::filesystem::remove(path);
}

TEST_CASE("a folder that is not there and a full disk are told with the file's name") {
  const auto nowhere = FileStream::create("/nowhere/at/all");
  REQUIRE(!nowhere.ok());
  CHECK(nowhere.failure().where == "/nowhere/at/all");
  auto full = FileStream::create("/dev/full");
  REQUIRE(full.ok());
  CHECK(full->write("more than nothing").ok());  // in the stream's own memory
  const Status done = full->finish();
  REQUIRE(!done.ok());
  CHECK(done.failure().where == "/dev/full");
  CHECK(done.failure().message.starts_with("cannot be written: "));
}

}  // namespace probe
