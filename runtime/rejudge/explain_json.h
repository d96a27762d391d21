// What `why` says, for programs.
#pragma once

#include "runtime/base/json.h"
#include "runtime/rejudge/explain.h"

namespace probe::rejudge {

// {task, episode, seed, steps, invalid (null: valid), claims[]{text, object, denoted[], holds}
// where there are some, metrics[]{metric, value, shown, readout, step, when, file, line,
// conditions[]{file, line, text, bodies, measured, truth, decides, alike}}}.
Json to_json(const EpisodeWhy& why);

}  // namespace probe::rejudge
