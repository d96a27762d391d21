#include "runtime/plan/verify.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <limits>
#include <random>

#include "runtime/plan/ids.h"
#include "runtime/plan/plan.h"
#include "tests/plan/defects.h"

using namespace probe;
using namespace probe::plan;

namespace {

void check_defects(const std::vector<Defect>& defects) {
  for (const Defect& defect : defects) {
    CAPTURE(defect.rule);
    const Failure failure = failure_after(defect.make);
    CAPTURE(failure.message);
    CAPTURE(failure.where);
    CHECK(failure.code == Fault::kPlan);
    CHECK(failure.message.find(defect.rule) != std::string::npos);
    CHECK(failure.where.starts_with(std::string(defect.section) + " at byte "));
  }
}

}  // namespace

TEST_CASE("a plan is rejected when any single byte of it is flipped") {
  auto bytes = small_plan();
  REQUIRE(verify(bytes).ok());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    for (const unsigned bits : {0x01u, 0x80u, 0xffu}) {
      bytes[i] ^= static_cast<std::byte>(bits);
      const Status status = verify(bytes);
      if (status.ok()) FAIL("flipping bits " << bits << " of byte " << i << " was not noticed");
      bytes[i] ^= static_cast<std::byte>(bits);
    }
  }
}

TEST_CASE("a plan that ends early or late is rejected") {
  const auto bytes = small_plan();
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    if (verify(std::span(bytes).first(size)).ok()) FAIL("cut to " << size);
  }
  auto longer = bytes;
  longer.push_back(std::byte{0});
  CHECK(!verify(longer).ok());
}

TEST_CASE("a plan may begin at any address") {
  const auto bytes = small_plan();
  std::vector<std::byte> shifted(bytes.size() + 1);
  std::ranges::copy(bytes, shifted.begin() + 1);
  CHECK(verify(std::span(shifted).subspan(1)).ok());
}

TEST_CASE("stage 1 names what is wrong with header and directory") {
  for (const EnvelopeDefect& c : envelope_defects()) {
    CAPTURE(c.rule);
    auto bytes = small_plan();
    Header header = read_header(bytes);
    auto directory = read_directory(bytes);
    REQUIRE(directory.size() == 25);
    c.make(header, directory);
    std::memcpy(bytes.data(), &header, sizeof header);
    std::memcpy(bytes.data() + sizeof header, directory.data(),
                directory.size() * sizeof(DirectoryEntry));
    const Status status = verify(bytes);
    REQUIRE(!status.ok());
    CAPTURE(status.failure().message);
    CHECK(status.failure().message.find(c.rule) != std::string::npos);
    CHECK(status.failure().where.find(" at byte ") != std::string::npos);
  }
}

TEST_CASE("bytes between sections are zero [gap]") {
  auto bytes = small_plan();
  const auto directory = read_directory(bytes);
  bytes[directory[0].offset + directory[0].size] = std::byte{1};
  CHECK(verify(bytes).failure().message == "bytes between sections are zero [gap]");
}

TEST_CASE("a later minor version may add sections that can be ignored, and no others") {
  const auto add_section = [](std::uint16_t minor, std::uint16_t flags) {
    auto bytes = small_plan();
    auto directory = read_directory(bytes);
    // The last section becomes one of a kind that this reader does not know; sources go with it.
    directory.resize(directory.size());
    directory.back().kind = 5000;
    directory.back().flags = flags;
    Header header = read_header(bytes);
    header.minor = minor;
    std::memcpy(bytes.data(), &header, sizeof header);
    seal(bytes, directory);
    return verify_envelope(bytes);
  };
  CHECK(add_section(1, kIgnorable).ok());
  CHECK(!add_section(1, 0).ok());
  CHECK(!add_section(0, kIgnorable).ok());
}

TEST_CASE("stage 2 names what is wrong with the catalogue") { check_defects(catalogue_defects()); }

TEST_CASE("stage 2 names what is wrong with tasks, episodes and lists") {
  check_defects(task_defects());
}

TEST_CASE("a name is as long as a file's may be, and no longer") {
  const auto named = [](std::size_t size) {
    return failure_after([&](Records& r, Writer& w) {
      r.tasks[1].name = w.text(std::string(size, 'x'));
      w.fill_ids();
    });
  };
  CHECK(named(255).message == "");
  CHECK(named(256).message == "the name of a task has at most 255 bytes, not 256 [word]");
}

TEST_CASE("stage 3 names what is wrong with a program") { check_defects(code_defects()); }

TEST_CASE("stage 4 recomputes all ids") {
  check_defects(identity_defects());
  Writer w = small_writer();
  std::ranges::reverse(w.records.spans);
  CHECK(verify(w.lay_out(), {.identity = false}).ok());
  CHECK(!verify(w.lay_out()).ok());
}

TEST_CASE("an empty plan is a plan") { CHECK(verify(Writer().lay_out()).ok()); }

TEST_CASE("random damage under fresh hashes never crashes, and what is accepted can be read") {
  const auto good = small_plan();
  const auto directory = read_directory(good);
  std::mt19937_64 draw(7);
  constexpr std::uint8_t kSpecial[] = {0x00, 0x01, 0x7f, 0x80, 0xff};
  std::size_t accepted = 0;
  for (int round = 0; round < 20000; ++round) {
    auto bytes = good;
    const std::size_t damages = 1 + draw() % 4;
    for (std::size_t i = 0; i < damages; ++i) {
      const DirectoryEntry& e = directory[draw() % directory.size()];
      const std::size_t at = e.offset + draw() % e.size;
      bytes[at] = draw() % 2 == 0 ? static_cast<std::byte>(kSpecial[draw() % std::size(kSpecial)])
                                  : static_cast<std::byte>(draw());
    }
    auto entries = directory;
    if (draw() % 8 == 0) {
      const std::size_t at = draw() % (entries.size() * sizeof(DirectoryEntry));
      reinterpret_cast<unsigned char*>(entries.data())[at] = static_cast<unsigned char>(draw());
    }
    seal(bytes, entries);
    const auto plan = Plan::from_bytes(std::move(bytes), {.identity = draw() % 2 == 0});
    if (!plan.ok()) {
      REQUIRE(!plan.failure().message.empty());
      continue;
    }
    ++accepted;
    std::size_t read = 0;
    for (const TaskRecord& task : plan->tasks()) {
      for (const BodyRecord& body : plan->bodies(task)) read += plan->text(body.name).size();
      for (const EpisodeRecord& episode : plan->episodes(task))
        read += plan->placements(episode).size();
    }
    REQUIRE(read > 0);
  }
  CHECK(accepted > 0);
}
