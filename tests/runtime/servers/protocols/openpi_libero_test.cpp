// What a policy of LIBERO behind openpi's server is sent, against what openpi's own client sends of
// the same pictures and states: tests/servers/transcripts/openpi_libero.csv, made by its code.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "runtime/base/sha256.h"
#include "runtime/scene/image.h"
#include "runtime/servers/profile_library.h"
#include "runtime/servers/served.h"
#include "runtime/servers/server_policy.h"
#include "runtime/servers/servers.h"
#include "runtime/wire/msgpack.h"
#include "tests/runtime/libero/reference.h"
#include "tests/runtime/servers/asking.h"

namespace probe::servers {
namespace {

// Keeps the bytes of a question and answers ten actions that do nothing.
class OpenpiListener final : public wire::Speaker {
 public:
  explicit OpenpiListener(std::shared_ptr<wire::Bytes> asked) : asked_(std::move(asked)) {}
  std::vector<wire::Frame> greet() override { return {packed(wire::Map{})}; }
  Reply answer(const wire::Frame& frame) override {
    *asked_ = frame.bytes;
    return {
        {packed(wire::Map{{"actions", wire::array_f64({10, 7}, std::vector<double>(70, 0.0))}})}};
  }

 private:
  static wire::Frame packed(const wire::Value& value) {
    return {false, wire::to_msgpack(value, wire::ArrayStyle::kBinKeys)};
  }
  std::shared_ptr<wire::Bytes> asked_;
};

std::vector<std::uint8_t> picture_of(const std::string& path) {
  const auto image = scene::load_image(path);
  REQUIRE_MESSAGE(image.ok(), to_text(image.failure()));
  REQUIRE(image->width == 256);
  REQUIRE(image->height == 256);
  std::vector<std::uint8_t> rgb;
  for (std::size_t i = 0; i < image->rgba.size(); ++i) {
    if (i % 4 != 3) rgb.push_back(image->rgba[i]);
  }
  return rgb;
}

// The first row of a table with a header, by column.
std::map<std::string, double> first_row(const std::string& path) {
  std::ifstream file(path);
  std::string header, row, name, cell;
  REQUIRE(std::getline(file, header));
  REQUIRE(std::getline(file, row));
  std::istringstream names(header), cells(row);
  std::map<std::string, double> out;
  while (std::getline(names, name, ',') && std::getline(cells, cell, ','))
    out[name] = std::stod(cell);
  return out;
}

Observation observed(const std::map<std::string, double>& row, Privileged& privileged) {
  Observation seen;
  // Anywhere: what is sent counts in the world.
  privileged.base = {{-0.66, 0, 0.912}, Quat::Identity()};
  seen.privileged = &privileged;
  for (int i = 1; i <= 7; ++i)
    seen.proprioception.joints.push_back(row.at("q" + std::to_string(i)));
  // The second finger counts upwards here.
  seen.proprioception.joints.insert(seen.proprioception.joints.end(),
                                    {row.at("f1"), -row.at("f2")});
  seen.proprioception.finger_joints = 2;
  seen.proprioception.tcp_in_base.position =
      Vec3(row.at("tcp_x"), row.at("tcp_y"), row.at("tcp_z")) - privileged.base.position;
  return seen;
}

}  // namespace

TEST_CASE("a policy of LIBERO gets the bytes of openpi's own client: pictures, words, state") {
  if (!test::has_reference()) {
    MESSAGE("skipped: no ../shared/reference/libero");
    return;
  }
  const auto asked = std::make_shared<wire::Bytes>();
  auto listener = wire::listen_websocket(
      "127.0.0.1", "0", [asked] { return std::make_unique<OpenpiListener>(asked); });
  REQUIRE_MESSAGE(listener.ok(), to_text(listener.failure()));
  const auto choice = choose_server(
      Protocol::kOpenpi, "//127.0.0.1:" + (*listener)->port() + "?profile=openpi_libero");
  REQUIRE_MESSAGE(choice.ok(), to_text(choice.failure()));
  const auto transport = make_transport(*choice);
  REQUIRE(transport.ok());
  REQUIRE((*transport)->open({}).ok());

  std::ifstream expected(VLAPROBE_SOURCE_DIR "/tests/servers/transcripts/openpi_libero.csv");
  std::string line;
  std::getline(expected, line);
  std::size_t tasks = 0;
  double farthest = 0;
  while (std::getline(expected, line)) {
    std::istringstream cells(line);
    std::string task, prompt, size, hash, numbers;
    std::getline(cells, task, ',');
    std::getline(cells, prompt, '"');
    std::getline(cells, prompt, '"');
    std::getline(cells, size, ',');
    std::getline(cells, size, ',');
    std::getline(cells, hash, ',');
    std::getline(cells, numbers);
    CAPTURE(task);
    const std::string path = test::reference() + "reference/" + task;
    Privileged privileged;
    Observation seen = observed(first_row(path + "_osc.csv"), privileged);
    const auto view = picture_of(path + "_t0_agentview.png");
    const auto wrist = picture_of(path + "_t0_wrist.png");
    seen.image = {256, 256, view};
    const CameraImage cameras[] = {{"agentview", {256, 256, view}}, {"wrist", {256, 256, wrist}}};
    seen.cameras = cameras;
    seen.prompt = prompt;
    const auto request = to_request(choice->profile, seen);
    REQUIRE_MESSAGE(request.ok(), to_text(request.failure()));
    const auto answer = (*transport)->ask(*request, {});
    REQUIRE_MESSAGE(answer.ok(), to_text(answer.failure()));

    std::istringstream state(numbers);
    for (const double ours : request->state) {
      double theirs = 0;
      REQUIRE(static_cast<bool>(state >> theirs));
      farthest = std::max(farthest, std::abs(ours - theirs));
    }
    // All else to the byte; the recording has its states with nine digits.
    wire::Bytes sent = *asked;
    CHECK(sent.size() == std::stoul(size));
    std::array<std::uint8_t, 64> bytes{};
    REQUIRE(request->state.size() == 8);
    std::memcpy(bytes.data(), request->state.data(), bytes.size());
    const auto at = std::ranges::search(sent, bytes);
    REQUIRE(!at.empty());
    std::ranges::fill(at, std::uint8_t{0});
    CHECK(to_hex(sha256(std::as_bytes(std::span(sent)))) == hash);
    ++tasks;
  }
  CHECK(tasks == 20);
  CHECK(farthest < 1e-7);
}

TEST_CASE("the state of LIBERO's policies is of a Panda, and of no other arm") {
  const auto profile = find_profile("openpi_libero");
  REQUIRE_MESSAGE(profile.ok(), to_text(profile.failure()));
  Profile alone = *profile;
  alone.images.resize(1);
  const std::vector<std::uint8_t> bytes(4 * 4 * 3, 9);
  Observation seen;
  seen.image = {4, 4, bytes};
  seen.proprioception.joints = {1, 2, 3, 4, 5, 6, 0.02, 0.02};
  seen.proprioception.finger_joints = 2;
  CHECK(to_request(alone, seen).failure().message ==
        "`state.layout = libero` is of a Panda: seven joints and two fingers, the robot has 6 and "
        "2");
  // Turned half round about a level axis and a little less, or a little more: the angle goes on.
  seen.proprioception.joints = {0, 0, 0, -2.4, 0, 2.4, 0.785, 0.02, 0.03};
  const auto state_at = [&](double wrist) {
    seen.proprioception.joints[5] = wrist;
    const auto request = to_request(alone, seen);
    REQUIRE_MESSAGE(request.ok(), to_text(request.failure()));
    return Vec3(request->state[3], request->state[4], request->state[5]);
  };
  const Vec3 less = state_at(2.35), more = state_at(2.45);
  CHECK((less - more).norm() < 0.2);
  CHECK(std::max(less.norm(), more.norm()) > 3.14159265358979);
  const auto request = to_request(alone, seen);
  CHECK(request->state[6] == 0.02);
  CHECK(request->state[7] == -0.03);
}

}  // namespace probe::servers
