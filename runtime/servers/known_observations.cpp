#include "runtime/servers/known_observations.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>

#include "runtime/base/clock.h"
#include "runtime/servers/connecting.h"
#include "runtime/servers/server_policy.h"

namespace probe::servers {
namespace {

using ObservationClock = std::chrono::steady_clock;

constexpr int kWidth = 640, kHeight = 480;
constexpr int kHorizon = 60;
constexpr const char* kWords[kInstructions] = {"put carrot on plate", "put the spoon on the towel"};

// Where the things of a picture stand, pixels: each picture's are at other places.
struct KnownPlaces {
  int left = 0, right = 0;
};
constexpr int kNearPictures = 6;
KnownPlaces places_of(int index) {
  if (index < kNearPictures) return {150 + 40 * index, 420 - 30 * index};
  // Steps without a common divisor with the widths, so that none comes twice.
  return {30 + index * 53 % 580, 60 + index * 101 % 520};
}

// A brown table under a grey wall with an orange and a blue thing on it. No policy knows it, but
// every policy takes it for a picture.
void add_known_row(const KnownPlaces& places, int y, wire::Bytes* rgb) {
  for (int x = 0; x < kWidth; ++x) {
    int color[3] = {165, 165, 170};
    if (y > 140) color[0] = 150 + (x * 7 + y * 3) % 17, color[1] = 115, color[2] = 80;
    if (std::abs(x - places.left) < 28 && std::abs(y - 300) < 14) {
      color[0] = 230, color[1] = 120, color[2] = 30;
    }
    const int dx = x - places.right, dy = y - 330;
    if (dx * dx + 3 * dy * dy < 60 * 60) color[0] = 60, color[1] = 90, color[2] = 190;
    for (const int channel : color) rgb->push_back(static_cast<std::uint8_t>(channel));
  }
}

// A row that has something of everything, by which pictures are told apart without making them.
constexpr int kTellingRow = 305;

}  // namespace

wire::Bytes known_picture(int index) {
  wire::Bytes rgb;
  rgb.reserve(static_cast<std::size_t>(kWidth) * kHeight * 3);
  for (int y = 0; y < kHeight; ++y) add_known_row(places_of(index), y, &rgb);
  return rgb;
}

policy::Proprioception known_state(bool is_mirrored, const KnownArm& arm) {
  const bool is_franka = arm.joints == 7;
  const double side = is_mirrored ? -1 : 1;
  constexpr double kAside = 0.05, kPi = std::numbers::pi;
  policy::Proprioception measured;
  measured.openness = 1;
  measured.finger_joints = arm.fingers;
  Mat3 down;
  if (is_franka) {
    down << 1, 0, 0, 0, -1, 0, 0, 0, -1;
    // franka_ros' ready pose, whose tool is 0.3069 m ahead at 0.4869 m; the last joint turns the
    // tool back by as much as the first one turns the arm.
    const double ahead = 0.3069, waist = side * std::asin(kAside / ahead);
    measured.tcp_in_base = {{ahead * std::cos(waist), side * kAside, 0.4869}, Quat(down)};
    measured.joints = {waist, -kPi / 4, 0, -3 * kPi / 4, 0, kPi / 2, kPi / 4 + waist};
  } else {
    down << 0, 0, 1, 0, 1, 0, -1, 0, 0;
    measured.tcp_in_base = {{0.3, side * kAside, 0.14}, Quat(down)};
    // The waist turns by as much as the tool stands aside, to within a degree.
    measured.joints = {side * 0.165, 0.040, 0.222, -0.005, 1.365, 0.002};
    if (arm.joints != measured.joints.size()) {
      measured.joints.assign(arm.joints, 0);
      if (arm.joints > 0) measured.joints[0] = side * 0.165;
    }
  }
  measured.joints.resize(measured.joints.size() + arm.fingers, is_franka ? 0.04 : 0.037);
  return measured;
}

bool is_known_observation(std::span<const std::uint8_t> picture, std::string_view words) {
  constexpr std::size_t kRow = std::size_t{kWidth} * 3;
  if (picture.size() != kRow * kHeight) return false;
  if (std::ranges::find(kWords, words) == std::end(kWords)) return false;
  wire::Bytes row;
  for (int index = 0; index <= kMostInBatch; ++index) {
    row.clear();
    add_known_row(places_of(index), kTellingRow, &row);
    if (std::ranges::equal(picture.subspan(kTellingRow * kRow, kRow), row))
      return std::ranges::equal(picture, known_picture(index));
  }
  return false;
}

Status KnownObservations::open() {
  PROBE_TRY(transport_.open(deadlines()));
  return transport_.adapt(profile_);
}

namespace {

// A pass over several observations may round otherwise than over one: an answer is another
// observation's where it is this many times nearer to that one's.
constexpr double kNearer = 10;

}  // namespace

double apart(const Chunk& here, const Chunk& there) {
  double most = 0;
  if (here.size() != there.size()) return std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < here.size(); ++k) {
    if (here[k].size() != there[k].size()) return std::numeric_limits<double>::infinity();
    for (std::size_t n = 0; n < here[k].size(); ++n)
      most = std::max(most, std::abs(here[k][n] - there[k][n]));
  }
  return most;
}

TogetherFinding compare_together(const std::vector<Chunk>& alone,
                                 const std::vector<Chunk>& together) {
  TogetherFinding finding;
  for (std::size_t i = 0; i < std::min(alone.size(), together.size()); ++i) {
    const std::string beginning = "in a batch, question " + std::to_string(i + 1) + " has ";
    const double own = apart(together[i], alone[i]);
    if (std::isinf(own)) {
      finding.mixed = beginning + std::to_string(together[i].size()) + " actions, alone " +
                      std::to_string(alone[i].size());
      continue;
    }
    finding.difference = std::max(finding.difference, own);
    for (std::size_t k = 0; k < alone.size(); ++k) {
      if (own <= kNearer * apart(together[i], alone[k])) continue;
      finding.mixed =
          beginning + "the answer that question " + std::to_string(k + 1) + " has alone";
    }
  }
  return finding;
}

Result<Request> KnownObservations::request_of(const KnownObservation& observation) const {
  const char* words = kWords[observation.words];
  const wire::Bytes rgb = known_picture(observation.picture);
  const policy::Image image{kWidth, kHeight, rgb};
  // One picture stands for every camera that the profile names.
  std::vector<policy::CameraImage> cameras;
  for (const ImageRule& rule : profile_.images) cameras.push_back({rule.camera, image});
  policy::Observation seen;
  seen.image = image;
  seen.cameras = cameras;
  seen.prompt = words;
  seen.proprioception = known_state(observation.is_mirrored, arm_);
  seen.horizon = kHorizon;
  return to_request(profile_, seen);
}

Result<std::vector<Chunk>> KnownObservations::ask_together(
    const std::vector<KnownObservation>& observations) {
  std::vector<Request> requests;
  for (const KnownObservation& observation : observations) {
    PROBE_ASSIGN(Request request, request_of(observation));
    requests.push_back(std::move(request));
  }
  std::vector<const Request*> all;
  for (const Request& request : requests) all.push_back(&request);
  ++asked_;
  PROBE_ASSIGN(auto answers, transport_.ask_all(all, deadlines()));
  std::vector<Chunk> chunks;
  for (auto& answer : answers) {
    if (!answer) return answer.failure();
    chunks.push_back(std::move(*answer));
  }
  return chunks;
}

Result<Sha256> KnownObservations::hash_of(const std::vector<KnownObservation>& observations) const {
  Hasher hasher;
  for (const KnownObservation& observation : observations) {
    PROBE_ASSIGN(const Request request, request_of(observation));
    const policy::Delivery delivery = delivery_of(request);
    hasher.hash(sha256(delivery.prompt_sha256 + delivery.image_sha256));
    hasher.bytes(std::as_bytes(std::span(request.state)));
    for (const auto& [key, state] : request.more_states)
      hasher.hash(sha256(key)).bytes(std::as_bytes(std::span(state)));
    const policy::Proprioception& arm = request.proprioception;
    hasher.bytes(std::as_bytes(std::span(arm.joints)));
  }
  return hasher.finish();
}

Result<Chunk> KnownObservations::ask(const KnownObservation& observation) {
  const char* words = kWords[observation.words];
  policy::EpisodeStart start;
  start.task = "policy_test";
  start.prompt = words;
  start.index = observation.picture;
  start.horizon = kHorizon;
  if (profile_.connection == ConnectionUse::kPerEpisode && asked_ > 0) {
    transport_.close();
    PROBE_TRY(transport_.open(deadlines()));
  }
  PROBE_TRY(transport_.begin_episode(start, deadlines()));
  PROBE_ASSIGN(const Request request, request_of(observation));
  const auto begun = ObservationClock::now();
  ++asked_;
  PROBE_ASSIGN(Chunk chunk, transport_.ask(request, deadlines()));
  times_.push_back(seconds_since(begun));
  PROBE_TRY(transport_.end_episode({true, false, 1}, deadlines()));
  return chunk;
}

Deadlines KnownObservations::deadlines() const {
  return {to_duration(profile_.connect_s),
          to_duration(times_.empty() ? std::max(profile_.first_s, profile_.answer_s)
                                     : profile_.answer_s)};
}

}  // namespace probe::servers
