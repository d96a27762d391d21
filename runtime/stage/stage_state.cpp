#include "runtime/stage/stage_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "runtime/base/bytes.h"
#include "runtime/plan/limits.h"

namespace probe::stage {
namespace {

constexpr std::array<std::uint8_t, 8> kMagic = {0x89, 'S', 'T', 'G', '\r', '\n', 0x1a, '\n'};
constexpr std::uint32_t kVersion = 1, kLateVersion = 2, kCountedVersion = 3, kToldVersion = 4;
constexpr std::size_t kCheckBytes = 8;
// Two objects of 256 parts of which each touches each of the other's would save 54 MB.
constexpr std::size_t kMostBytes = std::size_t{256} << 20;
constexpr std::size_t kStartBytes = 9 * sizeof(double);
constexpr std::size_t kMonitorBytes = sizeof(double) + 1;

Failure refuse(std::string message) { return {Fault::kWorld, std::move(message), ""}; }

void put_control(ByteWriter& to, const robot::ControlState& control) {
  to.vec(control.target.position);
  to.quat(control.target.rotation);
  to.reals(control.joint_targets);
  to.u8(control.reached ? 1 : 0);
}

robot::ControlState get_control(ByteReader& from) {
  robot::ControlState control;
  control.target.position = from.vec();
  control.target.rotation = from.quat();
  control.joint_targets = from.reals();
  control.reached = from.u8() != 0;
  return control;
}

// Whether an action on its way has other numbers than a tool's: it says how many, then.
bool has_counted(const StageState& state) {
  return state.told || std::ranges::any_of(state.world.waiting, [](const policy::Action& action) {
    return action.size() != robot::kActionSize;
  });
}

void put_late(ByteWriter& to, const StageState& state) {
  const bool is_counted = has_counted(state);
  to.u32(static_cast<std::uint32_t>(state.world.waiting.size()));
  for (const policy::Action& action : state.world.waiting) {
    if (is_counted) to.u32(static_cast<std::uint32_t>(action.size()));
    for (const double number : action) to.f64(number);
  }
  to.u32(static_cast<std::uint32_t>(state.past.size()));
  for (const PastPlaces& places : state.past) {
    to.u32(static_cast<std::uint32_t>(places.step));
    to.reals(places.q);
    to.u32(static_cast<std::uint32_t>(places.objects.size()));
    for (const Pose& pose : places.objects) {
      to.vec(pose.position);
      to.quat(pose.rotation);
    }
  }
}

// Whether it could be read.
bool get_late(ByteReader& from, bool is_counted, StageState& state) {
  constexpr std::size_t kFewest = sizeof(std::uint32_t) + sizeof(double);
  const std::size_t least = is_counted ? kFewest : sizeof(robot::ToolAction);
  state.world.waiting.resize(from.count(from.u32(), least));
  for (policy::Action& action : state.world.waiting) {
    const std::uint32_t size = is_counted ? from.u32() : robot::kActionSize;
    if (size == 0 || size > robot::kMostActionNumbers) return false;
    action = policy::Action::zeros(size);
    for (double& number : action) number = from.f64();
  }
  constexpr std::size_t kLeast = 3 * sizeof(std::uint32_t);
  state.past.resize(from.count(from.u32(), kLeast));
  for (PastPlaces& places : state.past) {
    places.step = static_cast<int>(std::min(from.u32(), 1'000'000'000u));
    places.q = from.reals();
    places.objects.resize(from.count(from.u32(), 7 * sizeof(double)));
    for (Pose& pose : places.objects) {
      pose.position = from.vec();
      pose.rotation = from.quat();
    }
  }
  return true;
}

void put_judge(ByteWriter& to, const vm::JudgeState& judge) {
  to.u32(static_cast<std::uint32_t>(judge.monitors.size()));
  for (const vm::JudgeState::Monitor& monitor : judge.monitors) {
    to.f64(monitor.value);
    to.u8(monitor.started ? 1 : 0);
  }
  to.reals(judge.values);
  to.u8(judge.decided ? 1 : 0);
}

vm::JudgeState get_judge(ByteReader& from) {
  vm::JudgeState judge;
  judge.monitors.resize(from.count(from.u32(), kMonitorBytes));
  for (vm::JudgeState::Monitor& monitor : judge.monitors) {
    monitor.value = from.f64();
    monitor.started = from.u8() != 0;
  }
  judge.values = from.reals();
  judge.decided = from.u8() != 0;
  return judge;
}

void put_told(ByteWriter& to, const vm::ToldState& told) {
  to.u32(told.sentence);
  to.u32(static_cast<std::uint32_t>(told.conditions.size()));
  for (const vm::JudgeState& condition : told.conditions) put_judge(to, condition);
}

vm::ToldState get_told(ByteReader& from) {
  vm::ToldState told{from.u32(), {}};
  constexpr std::size_t kLeast = 2 * sizeof(std::uint32_t) + 1;
  told.conditions.resize(from.count(from.u32(), kLeast));
  for (vm::JudgeState& condition : told.conditions) condition = get_judge(from);
  return told;
}

std::span<const std::byte> check_of(const Sha256& hash) {
  return std::as_bytes(std::span(hash.bytes)).first(kCheckBytes);
}

}  // namespace

std::vector<std::byte> StageState::to_bytes() const {
  ByteWriter to;
  for (const std::uint8_t byte : kMagic) to.u8(byte);
  const bool is_late = told || !world.waiting.empty() || !past.empty();
  to.u32(told                 ? kToldVersion
         : has_counted(*this) ? kCountedVersion : is_late ? kLateVersion : kVersion);
  to.u32(start);
  to.hash(episode_id);
  to.u32(static_cast<std::uint32_t>(world.steps));
  put_control(to, world.control);
  to.u32(static_cast<std::uint32_t>(world.starts.size()));
  for (const vm::BodyStart& body : world.starts) {
    to.vec(body.position);
    to.vec(body.half);
    to.vec(body.opening);
  }
  to.text({reinterpret_cast<const char*>(world.physics.data()), world.physics.size()});
  put_judge(to, judge);
  if (is_late) put_late(to, *this);
  if (told) put_told(to, *told);
  std::vector<std::byte> bytes = to.bytes();
  const Sha256 hash = sha256(std::span<const std::byte>(bytes));
  const auto check = check_of(hash);
  bytes.insert(bytes.end(), check.begin(), check.end());
  return bytes;
}

Result<StageState> StageState::from_bytes(std::span<const std::byte> bytes) {
  if (bytes.size() < kMagic.size() + sizeof kVersion + kCheckBytes ||
      std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) != 0) {
    return refuse("the bytes are not a saved stage");
  }
  if (bytes.size() > kMostBytes) {
    return refuse(fmt::format("a saved stage of {} bytes, no stage needs more than {}",
                              bytes.size(), kMostBytes));
  }
  ByteReader from(bytes.first(bytes.size() - kCheckBytes));
  from.take(kMagic.size());
  const std::uint32_t version = from.u32();
  const bool is_counted = version == kCountedVersion || version == kToldVersion,
             is_late = version == kLateVersion || is_counted;
  if (version != kVersion && !is_late) {
    return refuse(fmt::format("a saved stage of format {}, this program reads {} to {}", version,
                              kVersion, kToldVersion));
  }
  const Sha256 hash = sha256(bytes.first(bytes.size() - kCheckBytes));
  if (!std::ranges::equal(bytes.last(kCheckBytes), check_of(hash))) {
    return refuse("the saved stage is cut short or was changed: its check word differs");
  }
  StageState state;
  state.start = from.u32();
  state.episode_id = from.hash();
  const std::uint32_t steps = from.u32();
  constexpr std::uint32_t kMostSteps = 1'000'000'000;  // room to go on in an int
  state.world.steps = static_cast<int>(std::min(steps, kMostSteps));
  state.world.control = get_control(from);
  state.world.starts.resize(from.count(from.u32(), kStartBytes));
  for (vm::BodyStart& body : state.world.starts) {
    body.position = from.vec();
    body.half = from.vec();
    body.opening = from.vec();
  }
  const auto physics = from.take(from.u32());
  state.world.physics.assign(physics.begin(), physics.end());
  state.judge = get_judge(from);
  const bool is_read = !is_late || get_late(from, is_counted, state);
  if (is_read && version == kToldVersion) state.told = get_told(from);
  if (!is_read || !from.ok() || from.left() != 0 || steps > kMostSteps) {
    return refuse("the saved stage has another form than its version");
  }
  return state;
}

}  // namespace probe::stage
