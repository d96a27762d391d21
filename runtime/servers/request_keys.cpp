// What stands under which key in each protocol's request; the order and form are the protocols' own
// files'.
#include <span>
#include <string_view>

#include "runtime/servers/profile_check.h"
#include "runtime/servers/protocols/gr00t.h"

namespace probe::servers {
namespace {

// A key in one map of the request.
struct KeyUse {
  std::string map;  // empty: the outermost
  std::string key;
  std::string field;  // as in Mistake; empty: the protocol's own
  std::string shown;  // what messages call it
};

// Also those that a server looks for: a picture under such a key would be taken for something else.
std::vector<std::string_view> fixed_keys(Protocol protocol) {
  switch (protocol) {
    case Protocol::kIntact:
      return {"new_model_path", "reset"};
    case Protocol::kRoboArena:
      return {"endpoint", "session_id", "observation/joint_position",
              "observation/cartesian_position", "observation/gripper_position"};
    case Protocol::kVlaEval:
      return {"images", "task_name", "base_pose", "tcp_pose"};
    case Protocol::kOpenVla:
      return {"unnorm_key", "encoded"};
    case Protocol::kOpenpi:
    case Protocol::kGr00t:
      break;
  }
  return {};
}

std::vector<KeyUse> key_uses(const Profile& profile) {
  const bool is_nested = profile.protocol == Protocol::kGr00t && profile.dialect == "n1.6_nested";
  std::vector<KeyUse> uses;
  for (const std::string_view key : fixed_keys(profile.protocol)) {
    uses.push_back({"", std::string(key), "", ""});
  }
  for (std::size_t i = 0; i < profile.images.size(); ++i) {
    const ImageRule& image = profile.images[i];
    uses.push_back(
        {"", image.key, "image " + std::to_string(i + 1),
         "`image` (" + (image.camera.empty() ? "first" : image.camera) + " -> " + image.key + ")"});
    if (profile.protocol == Protocol::kVlaEval) uses.back().map = "images";
    if (!is_nested) continue;
    uses.back().map = "video";
    uses.back().key = gr00t_nested_image_key(image.key);
  }
  const bool has_state = profile.state_layout != StateLayout::kNone;
  if (has_state && profile.protocol == Protocol::kGr00t) {
    for (const std::string_view name : gr00t_state_names(profile.state_layout)) {
      if (is_nested) break;  // in a map of their own, without the profile's key
      uses.push_back({"", profile.state_key + "." + std::string(name), "state.key", "`state.key`"});
    }
  } else if (has_state && profile.protocol != Protocol::kRoboArena) {
    uses.push_back({"", profile.state_key, "state.key", "`state.key`"});
  }
  uses.push_back({is_nested ? "language" : "", profile.prompt_key, "prompt.key", "`prompt.key`"});
  return uses;
}

}  // namespace

std::optional<Mistake> find_key_conflict(const Profile& profile) {
  const std::vector<KeyUse> uses = key_uses(profile);
  for (std::size_t i = 0; i < uses.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const KeyUse &one = uses[j], &other = uses[i];
      if (one.map != other.map || one.key != other.key) continue;
      if (one.field.empty()) {
        return Mistake{other.shown + " has the key `" + other.key + "`, which is " +
                           std::string(to_word(profile.protocol)) + "'s own",
                       {other.field}};
      }
      return Mistake{one.shown + " and " + other.shown + " have the same key `" + other.key +
                         "`: one of them would never arrive",
                     {one.field, other.field}};
    }
  }
  return std::nullopt;
}

}  // namespace probe::servers
