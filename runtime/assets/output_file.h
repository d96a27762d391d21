// One rule for everything that writes a file where it is told to: what was asked about is not what is
// written over.
#pragma once

#include <span>
#include <string>

#include "runtime/base/result.h"

namespace probe::assets {

enum class Writes { kPlan, kTranscript, kOther };

// Fails (kUsage, where = out) when `out` is one of the files that the verb reads, Probe text, a
// mesh, URDF or profile that is there, a file that an asset folder's manifest lists, or what a
// folder of ours holds (runtime/base/folder_kind.h: of runs, answers, searches, arrays, sweeps),
// also through links; a plan that is there gives way to a plan alone, a transcript of a server to a
// transcript, and a picture to no plan. An empty `out` is none.
Status check_output(const std::string& out, std::span<const std::string> inputs = {},
                    Writes writes = Writes::kOther);

}  // namespace probe::assets
