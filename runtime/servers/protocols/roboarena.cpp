// RoboArena's dialect of openpi's protocol (roboarena/policy_server.py): {"endpoint": "infer" |
// "reset"}, and a server that says which pictures it wants and what its actions are. What a server
// leaves out is what RoboArena's evaluator takes it for (roboarena_evaluator 5992b26).
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>

#include "runtime/robot/rotation.h"
#include "runtime/servers/protocol.h"
#include "runtime/servers/protocols/openpi_connection.h"
#include "runtime/servers/protocols/served_sides.h"

namespace probe::servers {
namespace {

// Of the DROID robot, whose arm has seven joints.
constexpr std::size_t kArmJoints = 7;
// What a "velocity" of length 1 moves in a step, and a joint's of 1 (droid/robot_ik,
// robot_ik_solver.py).
constexpr double kSpeedM = 0.075, kSpeedRad = 0.15, kJointSpeedRad = 0.2;

// Of an attempt at an episode: a server that keeps histories by it must never meet one again, not
// in another run either.
std::string new_session() {
  static std::atomic<std::uint64_t> made{0};
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const auto us = std::chrono::duration_cast<std::chrono::microseconds>(now).count();
  return "vlaprobe-" + std::to_string(us) + "-" + std::to_string(getpid()) + "-" +
         std::to_string(++made);
}

class RoboArena : public Transport {
 public:
  RoboArena(const Profile& profile, const wire::Endpoint& server)
      : profile_(profile), connection_(server) {}

  Status open(const Deadlines& deadlines) override {
    PROBE_ASSIGN(config_, connection_.open(profile_, deadlines));
    return {};
  }
  void close() override { connection_.close(); }

  Status adapt(Profile& profile) const override {
    PROBE_TRY(choose_meaning(profile));
    PROBE_TRY(choose_images(profile));
    const wire::Value* size = config_.find("image_resolution");
    if (size == nullptr || *size == wire::Value()) return {};
    const auto sides = wire::to_numbers(*size);
    if (!sides || sides->size() != 2 || (*sides)[0] < 1 || (*sides)[1] < 1 || (*sides)[0] > 4096 ||
        (*sides)[1] > 4096) {
      return bad("expected `image_resolution` [height, width] or nil, got " +
                 wire::describe(*size));
    }
    for (ImageRule& image : profile.images) {
      if (image.width > 0) continue;
      image.height = static_cast<int>((*sides)[0]);
      image.width = static_cast<int>((*sides)[1]);
      image.resize = Resize::kLanczos;
    }
    return {};
  }

  Status begin_episode(const policy::EpisodeStart&, const Deadlines& deadlines) override {
    session_ = new_session();
    return reset(deadlines);
  }
  Status end_episode(const policy::EpisodeEnd&, const Deadlines& deadlines) override {
    return reset(deadlines);
  }
  Status reset(const Deadlines& deadlines) {
    PROBE_TRY(connection_.send(wire::Map{{"session_id", session_}, {"endpoint", "reset"}},
                               deadlines.answer));
    PROBE_ASSIGN(const wire::Message answer, connection_.receive_message(deadlines.answer));
    if (answer.is_text && answer.text() == "reset successful") return {};
    return answered("reset: expected the text `reset successful`, got " +
                    (answer.is_text ? last_lines(answer.text()) : "a binary message"));
  }

  Result<std::vector<RawAction>> ask(const Request& request, const Deadlines& deadlines) override {
    wire::Map map;
    append_images(request, &map);
    const policy::Proprioception& measured = request.proprioception;
    std::vector<double> joints = measured.joints;
    joints.resize(measured.arm_joints());
    joints.resize(std::max(joints.size(), kArmJoints), 0.0);
    const Vec3& at = measured.tcp_in_base.position;
    const Vec3 rpy = robot::to_rpy(measured.tcp_in_base.rotation);
    map.emplace_back("observation/joint_position", state_array(profile_, joints));
    map.emplace_back("observation/cartesian_position",
                     state_array(profile_, {at.x(), at.y(), at.z(), rpy.x(), rpy.y(), rpy.z()}));
    map.emplace_back("observation/gripper_position",
                     state_array(profile_, {1 - measured.openness}));  // DROID: 1 is closed
    if (wants("needs_session_id", false)) map.emplace_back("session_id", session_);
    map.emplace_back(profile_.prompt_key, request.prompt);
    map.emplace_back("endpoint", "infer");
    PROBE_ASSIGN(const wire::Value answer, connection_.ask(std::move(map), deadlines.answer));
    const wire::Value* actions = answer.find("actions");
    return to_actions(actions == nullptr ? answer : *actions, request.action_size);
  }

  std::vector<std::string> remarks() const override { return metadata_remarks(config_); }

 private:
  bool wants(std::string_view what, bool otherwise) const {
    const wire::Value* value = config_.find(what);
    return value == nullptr ? otherwise : *value == wire::Value(true);
  }

  // Its own word decides what the profile leaves open.
  Status choose_meaning(Profile& profile) const {
    const wire::Value* said = config_.find("action_space");
    const std::string space = said == nullptr                      ? "joint_position"
                              : said->as<std::string>() == nullptr ? ""
                                                                   : *said->as<std::string>();
    struct Meaning {
      std::string_view space;
      ActionForm form;
      ActionUnits units;
      double scale_m, scale_rad;
    };
    // The evaluator holds velocities of joints to -1 .. 1, each for itself.
    static constexpr Meaning kMeanings[] = {
        {"cartesian_velocity", ActionForm::kDelta, ActionUnits::kBall, kSpeedM, kSpeedRad},
        {"cartesian_position", ActionForm::kAbsolute, ActionUnits::kMetric, 1, 1},
        {"joint_velocity", ActionForm::kJointSteps, ActionUnits::kBox, 1, kJointSpeedRad},
        {"joint_position", ActionForm::kJoints, ActionUnits::kMetric, 1, 1}};
    for (const Meaning& meaning : kMeanings) {
      if (meaning.space != space) continue;
      if (profile.action_form != ActionForm::kUnsaid && profile.action_form != meaning.form) {
        return Failure{Fault::kUsage,
                       "the server's `action_space` is " + std::string(space) +
                           ", and the profile's `action.form` is of another",
                       ""};
      }
      profile.action_form = meaning.form;
      if (profile.action_units != ActionUnits::kUnsaid) return {};
      profile.action_units = meaning.units;
      profile.action_scale_m = meaning.scale_m;
      profile.action_scale_rad = meaning.scale_rad;
      return {};
    }
    return Failure{Fault::kUsage,
                   "the server's `action_space` is " + wire::describe(*said) +
                       "; \"joint_position\", \"joint_velocity\", \"cartesian_position\" and "
                       "\"cartesian_velocity\" can be done here",
                   ""};
  }

  // The profile's pictures that the server wants, and an error where it wants one more. The
  // evaluator counts outside cameras from 1.
  Status choose_images(Profile& profile) const {
    std::vector<std::string> wanted;
    const wire::Value* count = config_.find("n_external_cameras");
    const auto* cameras = count == nullptr ? nullptr : count->as<std::int64_t>();
    const bool is_stereo = wants("needs_stereo_camera", false);
    const std::int64_t outside = cameras == nullptr ? 1 : std::clamp<std::int64_t>(*cameras, 0, 16);
    for (std::int64_t i = 1; i <= outside; ++i) {
      const std::string key = "observation/exterior_image_" + std::to_string(i);
      wanted.push_back(key + "_left");
      if (is_stereo) wanted.push_back(key + "_right");
    }
    if (wants("needs_wrist_camera", true)) {
      wanted.emplace_back("observation/wrist_image_left");
      if (is_stereo) wanted.emplace_back("observation/wrist_image_right");
    }
    std::vector<ImageRule> images;
    for (const std::string& key : wanted) {
      const auto rule = std::find_if(profile.images.begin(), profile.images.end(),
                                     [&](const ImageRule& image) { return image.key == key; });
      if (rule == profile.images.end()) {
        return Failure{
            Fault::kUsage,
            "the server wants the picture `" + key + "`, for which the profile has no `image` line",
            ""};
      }
      images.push_back(*rule);
    }
    if (images.empty()) {
      return Failure{Fault::kUsage, "the server wants no picture: it could not see anything", ""};
    }
    profile.images = std::move(images);
    return {};
  }

  Profile profile_;
  OpenpiConnection connection_;
  wire::Value config_;
  std::string session_;
};

Result<std::unique_ptr<Transport>> make_roboarena(const Profile& profile,
                                                  const wire::Endpoint& server) {
  return std::unique_ptr<Transport>(std::make_unique<RoboArena>(profile, server));
}

// Its state is of its own form, whatever the profile says.
std::vector<KeyUse> roboarena_key_uses(const Profile& profile) {
  std::vector<KeyUse> uses = image_key_uses(profile);
  uses.push_back(prompt_key_use(profile));
  return uses;
}

constexpr std::array<std::string_view, 5> kRoboArenaKeys = {
    "endpoint", "session_id", "observation/joint_position", "observation/cartesian_position",
    "observation/gripper_position"};

}  // namespace

constinit const ProtocolRow roboarena_row{
    .word = "roboarena",
    .argument = "//HOST:PORT",
    .meaning = "a RoboArena server",
    .port = "8000",
    .options = {},
    .fixed_keys = kRoboArenaKeys,
    .key_uses = roboarena_key_uses,
    .make = make_roboarena,
    .serve = serve_roboarena,
    .served_options = "&chunk.length=any&chunk.use=all",
    .has_reset = always_has_reset,
    .has_joint_actions = true,
};

}  // namespace probe::servers
