// Profiles: what they may say, how they are found, and that ready ones are whole.
#include "runtime/servers/profile.h"

#include <doctest/doctest.h>

#include "runtime/servers/profile_library.h"
#include "runtime/servers/servers.h"

namespace probe::servers {
namespace {

constexpr std::string_view kSmall = "protocol = openpi\nimage = first -> observation/image\n";

std::string failure_of(const std::string& more) {
  const auto read = parse_profile(std::string(kSmall) + more, "mine.profile");
  REQUIRE_FALSE(read.ok());
  CHECK(read.failure().code == Fault::kUsage);
  return to_text(read.failure());
}

}  // namespace

TEST_CASE("an unknown field names the nearest and its place") {
  CHECK(failure_of("\n  action.rotatoin = euler\n") ==
        "mine.profile:4:3: a profile has no field `action.rotatoin`, did you mean "
        "`action.rotation`?");
  CHECK(failure_of("colour = red\n") == "mine.profile:3:1: a profile has no field `colour`");
}

TEST_CASE("a value that is none names those that are, with its own column") {
  CHECK(failure_of("action.rotation = eulr # sxyz\n") ==
        "mine.profile:3:19: `action.rotation` is one of unsaid, vector, euler, found `eulr`, did "
        "you mean "
        "`euler`?");
  CHECK(failure_of("chunk.use = 0\n") ==
        "mine.profile:3:13: `chunk.use` is a whole number from 1 to 1000, or `all`, found `0`");
  CHECK(failure_of("timeout.answer_s = nan\n").find("is a number above 0") != std::string::npos);
  CHECK(failure_of("action.low = 1 2 x\n") ==
        "mine.profile:3:14: `action.low` is made of numbers, found `x`");
  CHECK(failure_of("prompt.case =\n").find("mine.profile:3:1: ") == 0);
  CHECK(failure_of("just words\n") ==
        "mine.profile:3:1: a line is written `field = value`, found `just words`");
}

TEST_CASE("what does not go together is refused") {
  CHECK(failure_of("prompt.key = a\nprompt.key = b\n") ==
        "mine.profile:4:1: `prompt.key` is set twice");
  CHECK(failure_of("action.normalised = bound\n").find("bound needs `action.low`") !=
        std::string::npos);
  CHECK(failure_of("action.normalised = gaussian\naction.mean = 1 2 3\naction.std = 1 2 3\n")
            .find("has 3 numbers, there are 7") != std::string::npos);
  CHECK(failure_of("ensemble = temporal\nchunk.use = 4\n").find("asks at every step") !=
        std::string::npos);
  CHECK(failure_of("chunk.length = 2\nchunk.use = 4\n").find("more than") != std::string::npos);
  CHECK(failure_of("image = wrist -> observation/image\n").find("two images have the key") !=
        std::string::npos);
  CHECK(failure_of("image = wrist -> w 224x224\n").find("one of stretch, pad, crop") !=
        std::string::npos);
  CHECK(failure_of("image = wrist -> w pad\n").find("`pad` needs a size") != std::string::npos);
  CHECK_FALSE(parse_profile("image = first -> a\n", "x").ok());
  CHECK_FALSE(parse_profile("protocol = openpi\n", "x").ok());
}

TEST_CASE("two things with one key are refused, defaults too, at the later line") {
  CHECK(failure_of("image = wrist -> prompt\n") ==
        "mine.profile:3:9: `image` (wrist -> prompt) and `prompt.key` have the same key `prompt`: "
        "one of them would never arrive; `prompt.key` is not written and has its default");
  CHECK(failure_of("prompt.key = observation/image\n")
            .starts_with("mine.profile:3:14: `image` (first -> observation/image) and "
                         "`prompt.key` have the same key"));
  CHECK(failure_of("state.key = prompt\nstate.layout = joints\nprompt.key = prompt\n")
            .starts_with("mine.profile:5:14: `state.key` and `prompt.key` have the same key"));
  CHECK(failure_of("state.key = observation/image\nstate.layout = joints\n")
            .find("`image` (first -> observation/image) and `state.key`") != std::string::npos);
  // A state that is not sent takes no key.
  CHECK(parse_profile(std::string(kSmall) + "state.key = prompt\n", "x").ok());
}

TEST_CASE("a key of the protocol's own is refused, and keys of different maps are not compared") {
  const auto refusal = [](const std::string& text) {
    const auto read = parse_profile("protocol = " + text, "p");
    return read ? std::string("accepted") : to_text(read.failure());
  };
  CHECK(refusal("intact\nimage = first -> reset\n") ==
        "p:2:9: `image` (first -> reset) has the key `reset`, which is intact's own");
  CHECK(refusal("roboarena\nimage = first -> a\nprompt.key = endpoint\n") ==
        "p:3:14: `prompt.key` has the key `endpoint`, which is roboarena's own");
  CHECK(
      refusal("roboarena\nimage = first -> observation/joint_position\n").find("roboarena's own") !=
      std::string::npos);
  CHECK(refusal("vlaeval\nimage = first -> a\nprompt.key = images\n").find("vlaeval's own") !=
        std::string::npos);
  CHECK(refusal("vlaeval\nimage = first -> images\nimage = wrist -> prompt\n") == "accepted");
  CHECK(refusal("openvla\nimage = first -> unnorm_key\n").find("openvla's own") !=
        std::string::npos);
  const std::string gr00t = "gr00t\nstate.layout = xyz_rpy_openness\nstate.key = state\n";
  CHECK(refusal(gr00t + "image = first -> state.roll\n")
            .starts_with("p:4:9: `image` (first -> state.roll) and `state.key` have the same key "
                         "`state.roll`"));
  CHECK(refusal(gr00t + "dialect = n1.6_nested\nimage = first -> state.roll\n") == "accepted");
  CHECK(refusal(gr00t + "dialect = n1.6_nested\nimage = first -> a\nimage = w -> video.a\n")
            .starts_with("p:6:9: `image` (first -> a) and `image` (w -> video.a) have the same"));
}

TEST_CASE("a conflict of keys in an address is refused too") {
  const auto refused = choose_server(Protocol::kOpenpi, "//gpu?image=first%20-%3E%20prompt");
  REQUIRE_FALSE(refused.ok());
  CHECK(to_text(refused.failure()).starts_with("--policy: `image` (first -> prompt) and"));
}

TEST_CASE("a mask is made of 0 and 1, and nothing cannot be normalised") {
  CHECK(failure_of("action.mask = 1 1 2 1 1 1 1\n") ==
        "mine.profile:3:15: number 3 of `action.mask` is neither 0 nor 1");
  CHECK(failure_of("state.layout = xyz_rpy_openness\nstate.mask = 1 1 0.5 1 1 1 1\n") ==
        "mine.profile:4:14: number 3 of `state.mask` is neither 0 nor 1");
  const std::string statistics = "state.low = 0 0\nstate.high = 1 1\n";
  CHECK(failure_of(statistics + "state.normalise = bound\nstate.layout = none\n") ==
        "mine.profile:6:16: `state.normalise` normalises nothing: `state.layout = none` sends no "
        "state");
  CHECK(failure_of("state.normalise = gaussian\n") ==
        "mine.profile:3:19: `state.normalise` normalises nothing: `state.layout = none` sends no "
        "state; `state.layout` is not written and has its default");
  CHECK(failure_of("action.normalised = bound\naction.low = 0 0 0 0 0 0 0\n"
                   "action.high = 1 1 1 1 1 1 1\naction.mask = 0 0 0 0 0 0 0\n")
            .starts_with("mine.profile:6:15: `action.normalised` normalises nothing"));
  CHECK(failure_of("action.normalised = bound\n") ==
        "mine.profile:3:21: bound needs `action.low` and `action.high`, as many of each");
}

TEST_CASE("a profile's text reads back equal") {
  const auto read = parse_profile(
      "protocol = gr00t\nabout = \"a # inside\" # and one behind\n"
      "image = first -> video.image_0 256x252 crop chw_f32\nimage = wrist -> w\n"
      "image = wrist -> v 224x224 tf_lanczos3 jpeg95 chw_f32\nimage = wrist -> u jpeg95\n"
      "state.layout = joints\nstate.type = f64\naction.threshold = 0.5\n"
      "action.normalised = bound\naction.low = -1 -1 -1 -1 -1 -1 0\naction.high = 1 1 1 1 1 1 0\n"
      "action.mask = 1, 1, 1, 1, 1, 1, 0\nchunk.length = 8\nchunk.use = 3\ntimeout.wait_s = 0.25\n",
      "mine.profile");
  REQUIRE_MESSAGE(read.ok(), to_text(read.failure()));
  CHECK(read->about == "a # inside");
  CHECK(read->images[0].height == 252);
  CHECK(read->images[2].resize == Resize::kTfLanczos3);
  CHECK(read->images[2].is_jpeg);
  CHECK(read->images[3].is_jpeg);
  CHECK_FALSE(read->images[1].is_jpeg);
  const auto again = parse_profile(to_text(*read), "again");
  REQUIRE_MESSAGE(again.ok(), to_text(again.failure()));
  CHECK(*again == *read);
  CHECK(profile_sha256(*again) == profile_sha256(*read));
  Profile other = *read;
  other.about = "said otherwise";
  other.answer_s = 600;
  CHECK(profile_sha256(other) == profile_sha256(*read));
  other.chunk_use = 4;
  CHECK(profile_sha256(other) != profile_sha256(*read));
}

TEST_CASE("every ready profile is whole, says what it is and is found by its name") {
  REQUIRE(ready_profiles().size() >= 9);
  for (const ProfileText& ready : ready_profiles()) {
    CAPTURE(ready.name);
    const auto found = find_profile(ready.name);
    REQUIRE_MESSAGE(found.ok(), to_text(found.failure()));
    CHECK(found->name == ready.name);
    CHECK_FALSE(found->about.empty());
  }
  const auto path = find_profile(std::string(VLAPROBE_SOURCE_DIR) +
                                 "/runtime/servers/profiles/pi0_bridge.profile");
  REQUIRE(path.ok());
  CHECK(*path == *find_profile("pi0_bridge"));
  CHECK(find_profile("pi0_brige").failure().message.find("did you mean `pi0_bridge`?") !=
        std::string::npos);
  CHECK(find_profile("./nowhere.profile").failure().where == "./nowhere.profile");
}

TEST_CASE("a switch of the gripper is held by the Google robot's checkpoints as their authors do") {
  struct Held {
    const char* name;
    StickyRule rule;
    int steps;
  };
  for (const Held& held : {Held{"openvla_fractal", StickyRule::kLast, 15},
                           Held{"pi0_fractal", StickyRule::kSwitch, 10},
                           Held{"pi0_fractal_lerobot", StickyRule::kSwitch, 10}}) {
    CAPTURE(held.name);
    const auto profile = find_profile(held.name);
    REQUIRE(profile.ok());
    CHECK(profile->action_sticky == held.rule);
    CHECK(profile->action_sticky_steps == held.steps);
  }
  // Behind their classes of SimplerEnv's manner, which hold by themselves.
  for (const char* name :
       {"rt1_fractal", "rt1x_fractal", "octo_fractal", "spatialvla_fractal", "magma_fractal"}) {
    CAPTURE(name);
    const auto profile = find_profile(name);
    REQUIRE(profile.ok());
    CHECK(profile->action_sticky == StickyRule::kNone);
  }
}

TEST_CASE("the profile to copy has every default spelt out") {
  const auto copy = find_profile("copy_me");
  REQUIRE(copy.ok());
  for (const ProfileText& ready : ready_profiles()) {
    if (ready.name != "copy_me") continue;
    for (const char* field : {"prompt.full_stop", "state.normalise", "action.normalised",
                              "action.low", "ensemble.ratio", "timeout.first_s", "connection"}) {
      CAPTURE(field);
      // Statistics have no default: their lines stand there as comments.
      CHECK((ready.text.find(std::string("\n") + field) != std::string_view::npos ||
             ready.text.find(std::string("\n# ") + field) != std::string_view::npos));
    }
  }
}

TEST_CASE("options of a server's address are a profile's fields") {
  const auto choice = choose_server(
      Protocol::kOpenpi, "//gpu:9000?action.rotation=euler&timeout.answer_s=0.5&image=first->x");
  CHECK_FALSE(choice.ok());  // an image is written with blanks
  const auto fine =
      choose_server(Protocol::kOpenpi, "//gpu?action.rotation=euler&image=first%20-%3E%20rgb");
  REQUIRE_MESSAGE(fine.ok(), to_text(fine.failure()));
  CHECK(fine->profile.action_rotation == RotationForm::kEuler);
  CHECK(fine->profile.images == std::vector<ImageRule>{{"", "rgb"}});
  CHECK(fine->server.port == "8000");

  const auto near = choose_server(Protocol::kOpenpi, "//gpu?profil=x");
  REQUIRE_FALSE(near.ok());
  CHECK(near.failure().message.find("did you mean `profile`?") != std::string::npos);
  CHECK(choose_server(Protocol::kOpenpi, "//gpu?protocol=gr00t").failure().message ==
        "`protocol` is what stands before `://`; a URL (wss://, https://) has it once");
  const auto other = choose_server(Protocol::kOpenpi, "//gpu?profile=pi0_bridge");
  REQUIRE_FALSE(other.ok());
  CHECK(other.failure().message.find("intact://...") != std::string::npos);
}

TEST_CASE("a server's description has its profile and not its address") {
  const auto here = choose_server(Protocol::kIntact, "//here:1?model=/m");
  const auto there = choose_server(Protocol::kIntact, "//there:2?model=/m&timeout.answer_s=300");
  const auto otherwise = choose_server(Protocol::kIntact, "//here:1?model=/m&chunk.use=2");
  REQUIRE((here.ok() && there.ok() && otherwise.ok()));
  CHECK(describe(*here) == describe(*there));
  CHECK(describe(*here) != describe(*otherwise));
  CHECK(describe(*here).find("model /m") != std::string::npos);
}

}  // namespace probe::servers
