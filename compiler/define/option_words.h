// What else an option of a question may be called beside its name, for who reads answers: its last
// word, and phrases of the catalogue, where they fit it alone among the options.
#pragma once

#include "compiler/define/scene_objects.h"
#include "compiler/model/model.h"

namespace probe::sema {

// Fills AskedOption::words.
void add_option_words(const Model& model, const SceneObjects& scene, AskedQuestion& question);

}  // namespace probe::sema
