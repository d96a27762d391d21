// Plans whose numbers were replaced: the verifier refuses them, or a stage goes through a start,
// two steps and their pictures, the same each time, or says why not. PROBE_MUTATIONS=N for a
// campaign.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "runtime/base/apart.h"
#include "runtime/policy/policy.h"
#include "runtime/stage/stage.h"
#include "tests/runtime/run/table_plan.h"

namespace probe::stage {
namespace {

const std::string kAssets = VLAPROBE_SOURCE_DIR "/assets";

// Every real number of the records, but for constants of programs, which no world reads.
std::vector<double*> numbers_of(plan::Records& records) {
  std::vector<double*> all;
  const auto add = [&](auto& values) {
    for (double& value : values) all.push_back(&value);
  };
  for (plan::ObjectRecord& o : records.objects) {
    add(o.box_min), add(o.box_max);
    all.insert(all.end(), {&o.density, &o.friction});
  }
  for (plan::RobotRecord& r : records.robots) {
    for (plan::FingerRecord& finger : r.fingers) add(finger.opens);
    all.insert(all.end(), {&r.control_hz, &r.grip_closed, &r.grip_open, &r.finger_friction,
                           &r.finger_patch, &r.link_friction, &r.reach_min, &r.reach_max});
  }
  for (plan::DriveRecord& d : records.drives)
    all.insert(all.end(), {&d.stiffness, &d.damping, &d.limit});
  for (plan::CameraRecord& c : records.cameras) {
    add(c.position), add(c.aim_values);
    all.insert(all.end(), {&c.fx, &c.fy, &c.cx, &c.cy});
  }
  for (plan::LightRecord& l : records.lights) all.push_back(&l.ambient);
  for (plan::SunRecord& s : records.suns) {
    add(s.direction);
    all.push_back(&s.power);
  }
  for (plan::SceneRecord& s : records.scenes) {
    add(s.base_position), add(s.base_rotation), add(s.area);
    all.insert(all.end(), {&s.surface_z, &s.physics_hz, &s.friction});
  }
  for (plan::PlacementRecord& p : records.placements) add(p.position), add(p.rotation);
  for (plan::TaskRecord& t : records.tasks) all.insert(all.end(), {&t.drop, &t.settle});
  add(records.reals);
  return all;
}

void mutate(plan::Records& records, std::uint64_t number) {
  policy::Draws draws(number);
  const std::vector<double*> all = numbers_of(records);
  for (std::uint64_t changes = 1 + draws.next() % 3; changes > 0; --changes) {
    double& value = *all[draws.next() % all.size()];
    constexpr double kOdd[] = {0,    -0.0, 5e-324, 1e-300, 1e-30, 1e-9,  1e-6,     1e-5, 0.001,
                               0.01, 1,    -1,     10,     100,   1000,  1e4,      1e5,  1e6,
                               1e7,  1e8,  1e10,   1e38,   1e200, 1e308, INFINITY, NAN};
    switch (draws.next() % 4) {
      case 0:
        value = -value;
        break;
      case 1:
        value *= std::pow(10, static_cast<double>(draws.next() % 17) - 8);
        break;
      default:
        value = kOdd[draws.next() % std::size(kOdd)];
    }
  }
}

// "refused", "ran", or why it did not.
std::string go_through(const plan::Plan& plan) {
  const std::uint32_t tasks[] = {0};
  auto assets = SharedAssets::load(plan, kAssets, tasks);
  if (!assets) return to_text(assets.failure());
  auto stage = Stage::create(plan, 0, *assets, {.image = {32, 24}});
  if (!stage) return to_text(stage.failure());
  std::string before, why = "ran";
  for (int round = 0; round < 2; ++round) {
    std::string now;
    const auto look = [&]() -> Status {
      PROBE_ASSIGN(const auto seen, (*stage)->observe());
      for (const double q : (*stage)->q()) {
        if (!std::isfinite(q)) return Failure{Fault::kInternal, "a joint is not finite", ""};
      }
      now += to_hex((*stage)->state_hash()) + to_hex(sha256(std::as_bytes(seen.image.rgb)));
      return {};
    };
    const auto episode = [&]() -> Status {
      PROBE_TRY((*stage)->reset(0));
      PROBE_TRY(look());
      for (int step = 0; step < 2; ++step) {
        PROBE_TRY((*stage)->step(policy::Action{0.1, -0.1, 0.1, 0.2, 0, 0, 1}));
        PROBE_TRY(look());
      }
      return {};
    };
    if (const Status status = episode(); !status) now += why = to_text(status.failure());
    if (round == 1 && now != before) return "DIFFERS: " + before + " and " + now;
    before = std::move(now);
  }
  return why;
}

std::string outcome_of(std::uint64_t number) {
  const auto bytes =
      run::TablePlan(kAssets).write(1, 2, [&](plan::Records& records) { mutate(records, number); });
  if (!bytes) return "refused";
  const auto plan = plan::Plan::from_bytes(*bytes);
  if (!plan) return "DIFFERS: written and not read: " + to_text(plan.failure());
  return go_through(*plan);
}

TEST_CASE("what still falls when the time to settle ends begins no episode") {
  const auto outcome = [](double height) {
    const auto bytes = run::TablePlan(kAssets).write(
        1, 2, [&](plan::Records& records) { records.placements[0].position[2] = height; });
    REQUIRE(bytes.ok());
    const auto plan = plan::Plan::from_bytes(*bytes);
    REQUIRE(plan.ok());
    return go_through(*plan);
  };
  CHECK(outcome(1.5) == "ran");
  const std::string high = outcome(40);
  CHECK_MESSAGE(high.find("has not come to rest: it moves at ") != high.npos, high);
  CHECK_MESSAGE(high.find(" m above the surface, when the time to settle ends") != high.npos, high);
}

constexpr ApartLimits kLimits{.memory = std::size_t{8} << 30, .cpu_s = 1200, .clock_s = 2400};

TEST_CASE("a plan with other numbers is refused, or comes to its end the same way each time") {
  const char* asked = std::getenv("PROBE_MUTATIONS");
  const std::uint64_t count = asked == nullptr ? 60 : std::strtoull(asked, nullptr, 10);
  constexpr std::uint64_t kBatch = 20;
  int refused = 0, ran = 0, failed = 0;
  for (std::uint64_t first = 0; first < count; first += kBatch) {
    const std::uint64_t end = std::min(first + kBatch, count);
    const auto batch = [&](std::uint64_t from, std::uint64_t to) {
      return run_apart(
          [&](const AnswerWriter& write) {
            for (std::uint64_t i = from; i < to; ++i) {
              if (!write(std::to_string(i) + " " + outcome_of(i) + "\n")) return false;
            }
            return true;
          },
          kLimits);
    };
    const auto answer = batch(first, end);
    if (!answer) {
      // One at a time, to name it.
      for (std::uint64_t i = first; i < end; ++i) {
        CAPTURE(i);
        const auto alone = batch(i, i + 1);
        CHECK_MESSAGE(alone.ok(), (alone ? "" : to_text(alone.failure())));
      }
      continue;
    }
    std::string_view lines = answer->bytes();
    while (!lines.empty()) {
      const std::string_view line = lines.substr(0, lines.find('\n'));
      lines.remove_prefix(line.size() + 1);
      refused += line.ends_with(" refused");
      ran += line.ends_with(" ran");
      failed += !line.ends_with(" refused") && !line.ends_with(" ran");
      CHECK_MESSAGE(line.find("DIFFERS") == line.npos, std::string(line));
      if (!line.ends_with(" refused") && !line.ends_with(" ran")) MESSAGE(std::string(line));
    }
  }
  MESSAGE(refused << " refused, " << ran << " ran, " << failed << " said why not");
  CHECK(ran > 0);
  CHECK(refused > 0);
}

}  // namespace
}  // namespace probe::stage
