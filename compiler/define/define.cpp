#include "compiler/define/define.h"

#include "compiler/define/thing.h"

namespace probe::sema {

void define_model(Context& context) {
  define_attributes(context);
  define_objects(context);
  define_datasets(context);
  define_robots(context);
  define_cameras(context);
  define_lights(context);
  define_fixtures(context);
  define_things(context);
  define_scenes(context);
  define_roles(context);
  define_layouts(context);
  define_templates(context);
  define_predicates(context);
  define_metrics(context);
  define_tasks(context);
  define_starts(context);
  define_sets(context);
  define_questions(context);
  define_suites(context);
  define_spaces(context);
  ask_questions(context);
}

}  // namespace probe::sema
