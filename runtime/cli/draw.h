// `draw`: a task's starts from above, which takes the compiler alone, or what its phrases mean,
// which takes pictures of the world.
#pragma once

#include <string>

#include "runtime/cli/load.h"
#include "runtime/cli/verbs.h"

namespace probe::cli {

struct DrawArguments {
  std::string file, task, out;
  bool phrases = false;
  AssetOptions assets;
};

// Draws --phrases and returns the exit code. Null in a program that cannot, which then hands over.
using PhraseDrawing = int (*)(const LoadedPlan& loaded, const DrawArguments& arguments);

void add_draw(Verb app, int& exit, PhraseDrawing draw_phrases);

}  // namespace probe::cli
