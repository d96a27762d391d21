// std/controls.probe over a suite that knows nothing of it: each task of the kitchen without words,
// with words of nothing and of another task, with the first picture for ever, and in a mirror.
#include <doctest/doctest.h>
#include <unistd.h>

#include <map>

#include "runtime/plan/axes.h"
#include "runtime/plan/plan.h"
#include "tests/dsl/tree_copy.h"

using namespace probe;
namespace fs = std::filesystem;

namespace {

const char* const kControls = R"(use "suite/kitchen.probe"
use "std/controls.probe"
template stove_words frame untold "turn on the left knob"
camera still        like over_counter { sensor dropped 1 }
camera still_wrist  like eye_in_hand  { sensor dropped 1 }
camera mirror       like over_counter { sensor mirrored }
camera mirror_wrist like eye_in_hand  { sensor mirrored }
set core = tasks where not has baseline and (scene counter or scene corner)
derive "{t}_told_{w}" for t in core, w in templates of untold { say w }
set told = variants of core
derive "{t}_still"  for t in core { camera still as agentview; camera still_wrist as wrist }
derive "{t}_mirror" for t in core { camera mirror as agentview; camera mirror_wrist as wrist }
suite controlled trained on bridge_v2 { tasks core | variants of core; seeds 0 }
)";

}  // namespace

TEST_CASE("controls: every task of a suite, each against itself, one axis moved") {
  const std::string file =
      (fs::temp_directory_path() / ("probe_controls_" + std::to_string(getpid()) + ".probe"))
          .string();
  test::overwrite(file, kControls);
  auto made = build(std::span<const std::string>(&file, 1),
                    {.asset_root = VLAPROBE_SOURCE_DIR "/assets",
                     .suite = "controlled",
                     .library_folders = {VLAPROBE_SOURCE_DIR "/dsl", VLAPROBE_SOURCE_DIR}});
  fs::remove(file);
  REQUIRE_MESSAGE(made.ok(), (made.ok() ? "" : to_text(made.failure())));
  // Nothing is said of words that open, turn and name what is not there.
  CHECK_MESSAGE(made->diagnostics.empty(), render_text(made->diagnostics, made->sources));
  const auto plan = plan::Plan::from_bytes(std::move(made->plan));
  REQUIRE_MESSAGE(plan.ok(), (plan.ok() ? "" : to_text(plan.failure())));

  std::map<std::string, int> number;  // by what a control is
  for (const plan::TaskRecord& task : plan->tasks()) {
    if (task.baseline == plan::kNone) {
      ++number["core"];
      continue;
    }
    const plan::TaskRecord& baseline = plan->tasks()[task.baseline];
    const std::string name(plan->text(task.name)), of(plan->text(baseline.name));
    CAPTURE(name);
    REQUIRE(name.starts_with(of + "_"));
    const std::string control = name.substr(of.size() + 1);
    ++number[control];
    const std::string prompt(plan->text(task.prompt));
    if (control == "told_silence") CHECK(prompt.empty());
    if (control == "told_stove_words") CHECK(prompt == "turn on the left knob");
    const bool is_told = control.starts_with("told_");
    CHECK((prompt == plan->text(baseline.prompt)) == !is_told);
    CHECK(task.axes ==
          plan::bit(is_told ? plan::Axis::kLanguageAction : plan::Axis::kSensor));
  }
  // The stove's own words are no control of turning it on.
  CHECK(number == std::map<std::string, int>{{"core", 24},
                                             {"still", 24},
                                             {"mirror", 24},
                                             {"told_silence", 24},
                                             {"told_do_it", 24},
                                             {"told_go_on", 24},
                                             {"told_anything", 24},
                                             {"told_stove_words", 23}});
}
