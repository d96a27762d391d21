// Stored starts: an archive with a pickle, of which nothing is run.
#include "runtime/libero/states.h"

#include <doctest/doctest.h>
#include <zlib.h>

#include <filesystem>
#include <fstream>

#include "runtime/base/large.h"
#include "runtime/libero/zip.h"
#include "tests/hex.h"
#include "tests/runtime/libero/small.h"

namespace probe::libero {
namespace {

namespace fs = std::filesystem;

using Bytes = std::vector<std::uint8_t>;

struct StateFile {
  std::string path =
      (fs::temp_directory_path() / "vlaprobe_libero_states_test.pruned_init").string();
  ~StateFile() {
    std::error_code error;
    fs::remove(path, error);
  }
  void write(const Bytes& bytes) const {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }
};

BddlProblem small_problem() { return read_bddl(test::kSmallProblem, "small.bddl").problem; }

const JointsOf kJoints = {{"chest", {"drawer_slide"}}};

// What is said of a file; empty where it is read.
std::string refusal(const Bytes& bytes, const JointsOf& joints = kJoints) {
  const StateFile file;
  file.write(bytes);
  const auto states = read_states(file.path, small_problem(), joints);
  return states ? "" : states.failure().message;
}

// Where `what` stands behind `from`.
std::size_t find_bytes(const Bytes& bytes, std::string_view what, std::size_t from = 0) {
  for (std::size_t at = from; at + what.size() <= bytes.size(); ++at) {
    if (std::string_view(reinterpret_cast<const char*>(&bytes[at]), what.size()) == what) return at;
  }
  FAIL("not there");
  return 0;
}

}  // namespace

TEST_CASE("starts that Python stored are read in the order of the problem") {
  const StateFile file;
  file.write(test::from_hex(test::kSmallStates));
  const auto states = read_states(file.path, small_problem(), kJoints);
  REQUIRE_MESSAGE(states.ok(), to_text(states.failure()));
  REQUIRE(states->joint_names.size() == 1);
  CHECK(states->joint_names[0] == std::pair<std::string, std::string>{"chest_1", "drawer_slide"});
  REQUIRE(states->starts.size() == 2);
  const StartState& first = states->starts[0];
  CHECK(first.time == 0);
  CHECK(first.arm[0] == 0.035773);
  CHECK(first.arm[6] == 0.783743);
  CHECK(first.fingers == std::array<double, 2>{0.020833, -0.020833});
  REQUIRE(first.objects.size() == 3);
  CHECK(first.objects[0].position == std::array<double, 3>{-0.07, 0.03, 0.97});
  CHECK(first.objects[0].rotation == std::array<double, 4>{0.6, 0, 0, 0.8});
  CHECK(first.objects[2].position == std::array<double, 3>{0.15, 0, 0.95});
  CHECK(first.joints == std::vector<double>{-0.15});
  CHECK(first.fastest == 0);
  CHECK(states->starts[1].joints == std::vector<double>{-0.145});
}

TEST_CASE("rows of another problem are refused with both numbers") {
  CHECK(refusal(test::from_hex(test::kSmallStates), {}) ==
        "a start has 60 numbers, that of a problem with 3 objects and 0 joints of fixtures 58");
}

TEST_CASE("a pickle that would run something is refused by its name, and nothing is run") {
  CHECK(refusal(test::from_hex(test::kRunsAProgram)) ==
        "byte 2 of a pickle: the global `posix system` is not read");
}

TEST_CASE("an opcode that builds what is no array is refused by its name") {
  Bytes bytes = test::from_hex(test::kRunsAProgram);
  const std::size_t opcode = find_bytes(bytes, "cposix");
  bytes[opcode] = 0x69;  // INST
  CHECK(refusal(bytes) == "`/data.pkl` is not what it was when it was packed: another checksum");
  // With the checksum of what it is now, in the file's own head and in the directory's entry, the
  // pickle is read. Its bytes are stored as they are, two behind its beginning is the opcode.
  const std::size_t entry = find_bytes(bytes, "PK\x01\x02");
  const auto sum = crc32(0, &bytes[opcode - 2], bytes[entry + 24]);
  for (std::size_t i = 0; i < 4; ++i)
    bytes[14 + i] = bytes[entry + 16 + i] = static_cast<std::uint8_t>(sum >> (8 * i));
  CHECK(refusal(bytes) == "byte 2 of a pickle: opcode INST is not read");
}

TEST_CASE("archives that lie are refused before they fill the memory") {
  const Bytes zeros = test::from_hex(test::kZeros);
  const auto read = [](const Bytes& bytes, std::size_t most) {
    return read_zip_member(bytes, "/data.pkl", most, "a.zip");
  };
  REQUIRE(read(zeros, 4096).ok());
  CHECK(*read(zeros, 4096) == std::string(4096, '\0'));
  CHECK(to_text(read(zeros, 4095).failure()) ==
        "a.zip: `/data.pkl` has 4096 bytes unpacked, at most 4095 are read" + large_hint());
  // The directory's entry of the first file: its size unpacked stands 24 bytes behind the
  // signature.
  const std::size_t entry = find_bytes(zeros, "PK\x01\x02");
  Bytes small = zeros;
  small[entry + 24] = 100;
  small[entry + 25] = 0;
  CHECK_FALSE(read(small, 4096).ok());
  Bytes large = zeros;
  large[entry + 27] = 0x7f;  // two gigabytes
  CHECK(read(large, std::size_t{1} << 20).failure().message ==
        "`/data.pkl` has 2130710528 bytes unpacked, at most 1048576 are read" + large_hint());
  CHECK_FALSE(read(large, std::size_t{1} << 31).ok());
}

TEST_CASE("what is no archive, or one of other things, is refused") {
  CHECK(refusal({}) == "no zip archive");
  CHECK(refusal({'n', 'o'}) == "no zip archive");
  Bytes other = test::from_hex(test::kSmallStates);
  for (std::size_t i = 0; i < 2; ++i) {
    const std::size_t at = find_bytes(other, "data.pkl", i == 0 ? 0 : 100);
    other[at] = 'D';
  }
  CHECK(refusal(other) == "expected one `/data.pkl` in the zip archive, found 0");
  const Bytes whole = test::from_hex(test::kSmallStates);
  int read = 0;
  for (std::size_t size = 0; size < whole.size(); size += 7)
    read +=
        refusal(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size))).empty();
  // Where no more is missing than a part of the length of the archive's comment.
  CHECK(read <= 1);
}

TEST_CASE("a byte that is another is refused, or changes nothing that is read") {
  const Bytes whole = test::from_hex(test::kSmallStates);
  int read = 0;
  for (std::size_t at = 0; at < whole.size(); ++at) {
    Bytes bytes = whole;
    bytes[at] ^= 0x20;
    const StateFile file;
    file.write(bytes);
    const auto states = read_states(file.path, small_problem(), kJoints);
    if (!states) continue;
    ++read;
    CHECK(states->starts.size() == 2);
    CHECK(states->starts[0].arm[0] == 0.035773);
  }
  // Of 726: dates, attributes, versions, local headers (the directory has it again), the other
  // file.
  CHECK(read > 0);
  CHECK(read < 200);
}

}  // namespace probe::libero
