// A stage as bytes: what follows is the same bit for bit, and bytes that are no saved stage are
// refused with the reason.
#include "runtime/stage/stage_state.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "runtime/expert/expert.h"
#include "tests/runtime/stage/cabinet.h"

namespace probe::stage {
namespace {

constexpr StageOptions kBlind{.pictures = false};

void need(const Status& status) {
  REQUIRE_MESSAGE(status.ok(), (status.ok() ? "" : to_text(status.failure())));
}

StageState reread(const StageState& state) {
  const auto back = StageState::from_bytes(state.to_bytes());
  REQUIRE_MESSAGE(back.ok(), (back.ok() ? "" : to_text(back.failure())));
  return *back;
}

std::string refusal(std::span<const std::byte> bytes) {
  const auto state = StageState::from_bytes(bytes);
  REQUIRE(!state.ok());
  CHECK(state.failure().code == Fault::kWorld);
  return state.failure().message;
}

// The check word of the bytes as they are now: a damage that no check word shows.
void seal(std::vector<std::byte>& bytes) {
  const Sha256 hash = sha256(std::span<const std::byte>(bytes).first(bytes.size() - 8));
  std::memcpy(bytes.data() + bytes.size() - 8, hash.bytes.data(), 8);
}

// What a trace holds of a moment, but pictures.
std::string moment(const Stage& stage) {
  Hasher hash;
  const auto all = [&](const Vec3& v) { hash.f64s(std::span(v.data(), 3)); };
  for (const vm::BodySample& body : stage.sample().bodies) {
    all(body.position), all(body.origin), all(body.velocity), all(body.spin);
    hash.f64s(std::span(body.rotation.coeffs().data(), 4));
  }
  for (const vm::ContactSample& contact : stage.sample().contacts) {
    hash.u32(contact.a).u32(contact.b);
    all(contact.push);
  }
  for (const vm::BodyStart& body : stage.body_starts()) all(body.position), all(body.half);
  all(stage.sample().tcp);
  const double clock[] = {stage.sample().grip, stage.sample().step, stage.sample().time};
  hash.f64s(clock).f64s(stage.q()).f64s(stage.u()).f64s(stage.judge().values());
  return to_hex(hash.hash(stage.state_hash()).finish());
}

// The expert's actions beside a drawer, with the moments after them.
struct Played {
  std::vector<policy::Action> actions;
  std::vector<std::string> moments;
};

Played play(Stage& stage, int steps) {
  const auto expert = expert::make_expert({});
  REQUIRE(expert.ok());
  need(stage.reset(0));
  need((*expert)->begin(stage.introduction()));
  Played played;
  for (int step = 0; step < steps; ++step) {
    const auto seen = stage.observe();
    REQUIRE(seen.ok());
    const auto action = (*expert)->act(*seen);
    REQUIRE(action.ok());
    played.actions.push_back(*action);
    need(stage.step(*action));
    played.moments.push_back(moment(stage));
  }
  return played;
}

TEST_CASE("an episode goes on from bytes bit for bit, whenever they were taken") {
  const auto stage = test::open_with_cabinet(kBlind);
  const auto other = test::open_with_cabinet(kBlind);
  const Played played = play(*stage, 60);
  need(stage->reset(0));
  for (int at = 0; at < 60; at += 12) {
    const StageState saved = stage->save();
    CHECK(saved.to_bytes() == reread(saved).to_bytes());
    need(other->restore(reread(saved)));
    CHECK(other->steps() == at);
    CHECK(moment(*other) == moment(*stage));
    for (int step = at; step < 60; ++step) {
      need(other->step(played.actions[static_cast<std::size_t>(step)]));
      REQUIRE(moment(*other) == played.moments[static_cast<std::size_t>(step)]);
    }
    for (int step = at; step < at + 12; ++step) {
      need(stage->step(played.actions[static_cast<std::size_t>(step)]));
    }
    need(stage->restore(reread(saved)));
    for (int step = at; step < at + 12; ++step) {
      need(stage->step(played.actions[static_cast<std::size_t>(step)]));
      REQUIRE(moment(*stage) == played.moments[static_cast<std::size_t>(step)]);
    }
  }
}

TEST_CASE("bytes that are no saved stage are refused with the reason") {
  const auto stage = test::open_with_cabinet(kBlind);
  need(stage->reset(0));
  need(stage->step({0, 0, -0.02, 0, 0, 0, 1}));
  const std::vector<std::byte> good = stage->save().to_bytes();
  MESSAGE(good.size(), " bytes");
  CHECK(refusal({}) == "the bytes are not a saved stage");
  CHECK(refusal(std::as_bytes(std::span("a plan, a trace, a picture, or nothing at all"))) ==
        "the bytes are not a saved stage");
  for (std::size_t size = 0; size < good.size(); size += size < 200 ? 1 : 97) {
    CHECK(refusal(std::span(good).first(size)).find("stage") != std::string::npos);
  }
  for (std::size_t at = 0; at < good.size(); at += at < 400 ? 1 : 31) {
    std::vector<std::byte> bad = good;
    bad[at] ^= std::byte{0x10};
    CHECK(refusal(bad).find("saved stage") != std::string::npos);
  }
  std::vector<std::byte> longer = good;
  longer.push_back({});
  CHECK(refusal(longer).find("check word") != std::string::npos);
  seal(longer);
  CHECK(refusal(longer) == "the saved stage has another form than its version");
  std::vector<std::byte> newer = good;
  newer[8] = std::byte{7};
  CHECK(refusal(newer) == "a saved stage of format 7, this program reads 1 to 4");
}

TEST_CASE("counts that a check word bears out take no memory and are refused") {
  const auto stage = test::open_furnished({}, kBlind);
  need(stage->reset(0));
  const std::vector<std::byte> good = stage->save().to_bytes();
  // Each aligned or unaligned u32 in turn says four billion.
  std::size_t refused = 0;
  for (std::size_t at = 12; at + 12 < std::min<std::size_t>(good.size(), 900); ++at) {
    std::vector<std::byte> bad = good;
    std::fill_n(bad.begin() + static_cast<std::ptrdiff_t>(at), 4, std::byte{0xff});
    seal(bad);
    const auto state = StageState::from_bytes(bad);
    refused += state.ok() ? 0 : 1;
  }
  CHECK(refused > 4);
}

TEST_CASE("damage that a check word bears out is refused, or the stage goes on or says why not") {
  const auto stage = test::open_with_cabinet(kBlind);
  need(stage->reset(0));
  for (int i = 0; i < 4; ++i) need(stage->step({0, 0, -0.02, 0, 0, 0, -1}));
  const StageState saved = stage->save();
  const std::vector<std::byte> good = saved.to_bytes();
  std::mt19937_64 draw(7);
  std::size_t no_form = 0, refused = 0, ran = 0, failed = 0;
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<std::byte> bad = good;
    for (std::size_t n = 1 + draw() % 3; n > 0; --n) {
      // Magic and version stay; half of the damage is among the first fields and the counts.
      const std::size_t room = trial % 2 == 0 ? 1500 : bad.size();
      const std::size_t at = 12 + draw() % (std::min(room, bad.size()) - 20 - 12);
      bad[at] = static_cast<std::byte>(draw() & 0xff);
    }
    seal(bad);
    const auto state = StageState::from_bytes(bad);
    if (!state) {
      ++no_form;
      continue;
    }
    if (const Status restored = stage->restore(*state); !restored) {
      CHECK(!restored.failure().message.empty());
      ++refused;
      continue;
    }
    const Status stepped = stage->step({0.01, 0, 0, 0, 0, 0, 1});
    (stepped ? ran : failed) += 1;
  }
  MESSAGE(no_form, " of another form, ", refused, " refused, ", ran, " ran, ", failed, " failed");
  CHECK(ran > 20);
  CHECK(refused > 5);
  // After all that the stage is as good as new.
  need(stage->restore(saved));
  CHECK(stage->save().to_bytes() == good);
}

TEST_CASE("a state of another start or task is refused by name") {
  const auto stage = test::open_with_cabinet(kBlind);
  need(stage->reset(0));
  StageState state = stage->save();
  state.start = 1;
  const Status other = stage->restore(state);
  REQUIRE(!other.ok());
  CHECK(other.failure().message == "the saved state is of another plan, task or start");
  state.start = 1u << 30;
  CHECK(!stage->restore(state).ok());
}

TEST_CASE("an episode is done at its horizon") {
  const auto stage = test::open_furnished({}, kBlind);
  need(stage->reset(0));
  const int horizon = stage->observe()->horizon;
  CHECK(horizon == 60);
  for (int step = 0; step < horizon; ++step) {
    CHECK(!stage->done());
    need(stage->step({0, 0, 0, 0, 0, 0, 1}));
  }
  CHECK(stage->done());
  need(stage->restore(reread(stage->save())));
  CHECK(stage->done());
  need(stage->reset(1));
  CHECK(!stage->done());
}

}  // namespace
}  // namespace probe::stage
