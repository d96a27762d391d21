// From declarations to the model: text in, tables out, one file a construct.
#pragma once

#include "compiler/names/context.h"

namespace probe::sema {

// In: the symbols of all files. Out: the model, whole; what cannot be read is reported, and its
// record is marked so that nothing which follows from it is said again. Nothing that was read is
// judged here: that is check/. The order is that of need, each reads the tables of those above it:
// attributes, facts -> objects -> datasets robots -> cameras, lights, fixtures -> scenes roles ->
// layouts; templates; predicates -> metrics tasks, with what every `derive` makes -> starts -> sets
// -> questions -> suites -> what is asked; spaces
void define_model(Context& context);

void define_attributes(Context& context);
void define_objects(Context& context);
void define_datasets(Context& context);
void define_robots(Context& context);
void define_cameras(Context& context);
void define_lights(Context& context);
void define_fixtures(Context& context);
void define_scenes(Context& context);
void define_roles(Context& context);
void define_layouts(Context& context);
void define_templates(Context& context);
void define_predicates(Context& context);
void define_metrics(Context& context);
void define_tasks(Context& context);
void define_starts(Context& context);
void define_sets(Context& context);
void define_questions(Context& context);
void define_suites(Context& context);
void define_spaces(Context& context);
void ask_questions(Context& context);  // of every task that a suite asks them of

}  // namespace probe::sema
