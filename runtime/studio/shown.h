// What the page shows at one moment: a text that checks, compiled, and what of its tasks is loaded.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/emit/compile.h"
#include "runtime/base/asset_root.h"
#include "runtime/base/json.h"
#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/stage/assets.h"

namespace probe::studio {

struct Shown {
  plan::Plan plan;
  AssetRoot asset_root;
  std::vector<ReferringWords> referring;
  std::vector<bool> is_own;  // by task of the plan: written in the text itself, not in what it uses
};

// By task: whether `file` declares it, the text that the plan is of.
std::vector<bool> own_tasks(const plan::Plan& plan, const std::string& file);

// Its index; where the name is empty or nothing's, the first of the text's own, else the first.
// Nothing: the text has no tasks.
std::optional<std::uint32_t> find_shown(const Shown& shown, const std::string& name);

// {tasks: [{name, is_own, prompt, baseline (null: none), axes[], starts, horizon (steps), hz,
// metrics[{name, truth}], words[{words, role, object}]}], episodes, suites[{name, tasks,
// episodes}]}. `words` are of the prompt that mean an object, in the order of the roles.
Json summary(const Shown& shown);

}  // namespace probe::studio
