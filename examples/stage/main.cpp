// A task's world stepped from outside: stage_example PLAN ASSETS TASK STATE
// Begins the task's first episode; after ten steps the stage is written to STATE and the episode
// goes on to its end. Where STATE is there, the episode goes on from it: the last line is the same.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <utility>

#include "runtime/base/file.h"
#include "runtime/stage/stage.h"

namespace {

using namespace probe;

[[noreturn]] void give_up(const Failure& failure) {
  std::fprintf(stderr, "stage_example: %s\n", to_text(failure).c_str());
  std::exit(1);
}
void need(const Status& status) {
  if (!status) give_up(status.failure());
}
template <typename T>
T need(Result<T> result) {
  if (!result) give_up(result.failure());
  return std::move(result).value();
}

// Reaches out while it goes down, then closes the gripper and goes up: numbers 0-2 are metres, 3-5
// a rotation vector, 6 is the gripper from -1 closed to 1 open.
policy::Action act(const policy::Observation& seen) {
  const bool down = seen.step < seen.horizon / 2;
  return {down ? 0.005 : 0.0, 0, down ? -0.01 : 0.01, 0, 0, 0.02, down ? 1.0 : -1.0};
}

}  // namespace

int main(int count, char** words) {
  if (count != 5) {
    std::fprintf(stderr, "usage: stage_example PLAN ASSETS TASK STATE\n");
    return 2;
  }
  const plan::Plan plan = need(plan::Plan::open(words[1]));
  const auto task = plan.find_task(words[3]);
  if (!task) give_up({Fault::kUsage, "the plan has no such task", words[3]});
  const std::uint32_t tasks[] = {*task};
  const auto assets = need(stage::SharedAssets::load(plan, words[2], tasks));
  const auto stage = need(stage::Stage::create(plan, *task, assets, {.image = {160, 120}}));

  const std::string file = words[4];
  if (std::filesystem::exists(file)) {
    const std::string bytes = need(read_file(file));
    need(stage->restore(need(stage::StageState::from_bytes(std::as_bytes(std::span(bytes))))));
  } else {
    need(stage->reset(0));
  }
  while (!stage->done()) {
    const policy::Observation seen = need(stage->observe());  // seen.image.rgb is the picture
    need(stage->step(act(seen)));
    if (stage->steps() == 10) {
      const auto bytes = stage->save().to_bytes();
      std::ofstream(file, std::ios::binary)
          .write(reinterpret_cast<const char*>(bytes.data()),
                 static_cast<std::streamsize>(bytes.size()));
    }
  }
  const vm::Judge& judge = stage->judge();
  for (std::uint32_t m = 0; m < judge.metric_count(); ++m) {
    std::printf("%s %g, ", judge.metric_name(m).c_str(), judge.value(m));
  }
  std::printf("%d steps, state %s\n", stage->steps(), to_hex(stage->state_hash()).c_str());
}
