// What `--allow-large` changes, in a process of its own: it holds for a whole process.
#include "runtime/base/large.h"

#include <doctest/doctest.h>

#include <cstdint>
#include <fstream>
#include <limits>
#include <string>

#include "runtime/base/apart.h"
#include "runtime/base/file.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe {
namespace {

// What `say` gives where large files are allowed.
std::string where_allowed(const std::function<std::string()>& say) {
  const auto answer = run_apart([&](const AnswerWriter& write) {
    allow_large();
    return write(say());
  });
  REQUIRE_MESSAGE(answer.ok(), (answer ? "" : to_text(answer.failure())));
  return std::string(answer->bytes());
}

TEST_CASE("a limit is what it is usually, until large files are allowed") {
  CHECK(allowed(10) == 10);
  CHECK(large_hint() == "; `vlaprobe --allow-large` allows 8 times as much");
  CHECK(where_allowed([] { return std::to_string(allowed(10)) + large_hint(); }) == "80");
  constexpr auto kMost = std::numeric_limits<std::uint64_t>::max();
  CHECK(where_allowed([] { return std::to_string(allowed(kMost)); }) == std::to_string(kMost));
  CHECK(where_allowed([] { return std::to_string(allowed(kMost / 8 + 1)); }) ==
        std::to_string(kMost));
}

TEST_CASE("a file may then be larger, and one that is larger still is refused without a hint") {
  const run::TemporaryFolder folder;
  std::ofstream(folder / "a") << "0123456789";
  const auto read = [&](std::size_t most) {
    const auto got = read_file(folder / "a", {.most = most});
    return got ? *got : got.failure().message;
  };
  CHECK(read(5) == "has more than the 5 bytes that are read" + large_hint());
  CHECK(where_allowed([&] { return read(5); }) == "0123456789");
  CHECK(where_allowed([&] { return read(1); }) == "has more than the 8 bytes that are read");
  // A file whose beginning is enough has no more of it.
  CHECK(where_allowed([&] {
          return read_file(folder / "a", {.most = 3, .only_begin = true}).value();
        }) == "012");
}

}  // namespace
}  // namespace probe
