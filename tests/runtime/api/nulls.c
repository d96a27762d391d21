/* NULL in place of each handle and argument of vlaprobe.h that must be there: refused by name, and
 * nothing dies. interface_test.cpp holds the functions that are named here against the header's. */
#include "nulls.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static vlaprobe_error error;

static void refused(int line, const char* call, int32_t code, const char* name) {
  if (code == VLAPROBE_USAGE && error.message != NULL && strstr(error.message, name) != NULL &&
      strstr(error.message, "NULL") != NULL) {
    vlaprobe_error_clear(&error);
    return;
  }
  fprintf(stderr, "nulls.c:%d: %s gives %d: %s\n", line, call, (int)code,
          error.message != NULL ? error.message : "no message");
  exit(1);
}
static void empty(int line, const char* call, int is_empty) {
  if (is_empty) return;
  fprintf(stderr, "nulls.c:%d: %s is not empty\n", line, call);
  exit(1);
}
/* `name` is what the header calls the argument. */
#define REFUSED(name, call) refused(__LINE__, #call, call, "`" name "`")
#define EMPTY(call) empty(__LINE__, #call, (call) == 0)

static void of_plans(const vlaprobe_plan* plan, const char* file) {
  vlaprobe_plan* made = NULL;
  const char* with_null[] = {file, NULL};
  char* json = NULL;
  size_t found = 0;
  vlaprobe_task task;
  vlaprobe_suite suite;
  vlaprobe_episode episode;
  vlaprobe_placement placement;
  REFUSED("files", vlaprobe_compile(NULL, 1, NULL, &made, &error));
  REFUSED("files", vlaprobe_compile(with_null, 2, NULL, &made, &error));
  REFUSED("plan", vlaprobe_compile(&file, 1, NULL, NULL, &error));
  REFUSED("path", vlaprobe_plan_open(NULL, NULL, &made, &error));
  REFUSED("plan", vlaprobe_plan_open(file, NULL, NULL, &error));
  REFUSED("bytes", vlaprobe_plan_from_bytes(NULL, 9, NULL, &made, &error));
  REFUSED("plan", vlaprobe_plan_from_bytes(file, 1, NULL, NULL, &error));
  EMPTY(vlaprobe_plan_root(NULL));
  EMPTY(vlaprobe_plan_assets(NULL));
  EMPTY(vlaprobe_plan_bytes(NULL, &found));
  EMPTY(vlaprobe_plan_warnings(NULL));
  EMPTY(vlaprobe_plan_diagnostics(NULL));
  EMPTY(vlaprobe_plan_task_count(NULL));
  EMPTY(vlaprobe_plan_suite_count(NULL));
  REFUSED("plan", vlaprobe_plan_task(NULL, 0, &task, &error));
  REFUSED("out", vlaprobe_plan_task(plan, 0, NULL, &error));
  REFUSED("plan", vlaprobe_plan_find_task(NULL, "x", &found, &error));
  REFUSED("name", vlaprobe_plan_find_task(plan, NULL, &found, &error));
  REFUSED("task", vlaprobe_plan_find_task(plan, "carrot_on_plate", NULL, &error));
  REFUSED("plan", vlaprobe_plan_describe(NULL, 0, &json, &error));
  REFUSED("json", vlaprobe_plan_describe(plan, 0, NULL, &error));
  REFUSED("plan", vlaprobe_plan_list(NULL, &json, &error));
  REFUSED("json", vlaprobe_plan_list(plan, NULL, &error));
  REFUSED("plan", vlaprobe_plan_suite(NULL, 0, &suite, &error));
  REFUSED("out", vlaprobe_plan_suite(plan, 0, NULL, &error));
  REFUSED("plan", vlaprobe_plan_episode(NULL, 0, 0, &episode, &error));
  REFUSED("out", vlaprobe_plan_episode(plan, 0, 0, NULL, &error));
  REFUSED("plan", vlaprobe_plan_placement(NULL, 0, 0, 0, &placement, &error));
  REFUSED("out", vlaprobe_plan_placement(plan, 0, 0, 0, NULL, &error));
  REFUSED("plan", vlaprobe_plan_load(NULL, &found, 1, &error));
  vlaprobe_plan_forget(NULL);
}

static void of_stages(const vlaprobe_plan* plan, size_t task) {
  const vlaprobe_stage_options options = {.size = sizeof options, .no_pictures = 1};
  vlaprobe_stage* stage = NULL;
  REFUSED("plan", vlaprobe_stage_create(NULL, task, &options, &stage, &error));
  REFUSED("stage", vlaprobe_stage_create(plan, task, &options, NULL, &error));
  if (vlaprobe_stage_create(plan, task, &options, &stage, &error) != VLAPROBE_OK ||
      vlaprobe_stage_reset(stage, 0, &error) != VLAPROBE_OK)
    exit(1);
  vlaprobe_state state;
  vlaprobe_array array;
  double action[VLAPROBE_ACTION_SIZE] = {0};
  char hash[65];
  int32_t side = 0;
  size_t size = 0;
  const void* bytes = NULL;
  REFUSED("stage", vlaprobe_stage_reset(NULL, 0, &error));
  REFUSED("stage", vlaprobe_stage_step(NULL, action, 7, &error));
  REFUSED("action", vlaprobe_stage_step(stage, NULL, 7, &error));
  vlaprobe_action_space space;
  REFUSED("stage", vlaprobe_stage_action_space(NULL, &space, &error));
  REFUSED("out", vlaprobe_stage_action_space(stage, NULL, &error));
  REFUSED("stage", vlaprobe_stage_state(NULL, &state, &error));
  REFUSED("out", vlaprobe_stage_state(stage, NULL, &error));
  REFUSED("stage", vlaprobe_stage_hash(NULL, hash, &error));
  REFUSED("hash", vlaprobe_stage_hash(stage, NULL, &error));
  REFUSED("stage", vlaprobe_stage_observe(NULL, &error));
  REFUSED("stage", vlaprobe_stage_picture(NULL, 0, VLAPROBE_RGB, &array, &error));
  REFUSED("out", vlaprobe_stage_picture(stage, 0, VLAPROBE_RGB, NULL, &error));
  EMPTY(vlaprobe_stage_camera(NULL, 0));
  EMPTY(vlaprobe_stage_metric(NULL, 0));
  EMPTY(vlaprobe_stage_metric_is_truth(NULL, 0));
  EMPTY(vlaprobe_stage_instruction(NULL));
  EMPTY(vlaprobe_batch_instruction(NULL, 0));
  EMPTY(vlaprobe_stage_joint(NULL, 0));
  EMPTY(vlaprobe_stage_object(NULL, 0));
  EMPTY(vlaprobe_stage_body(NULL, 0));
  REFUSED("stage", vlaprobe_stage_picture_size(NULL, 0, &side, &side, &error));
  REFUSED("height", vlaprobe_stage_picture_size(stage, 0, NULL, &side, &error));
  REFUSED("width", vlaprobe_stage_picture_size(stage, 0, &side, NULL, &error));
  REFUSED("stage", vlaprobe_stage_save(NULL, &bytes, &size, &error));
  REFUSED("bytes", vlaprobe_stage_save(stage, NULL, &size, &error));
  REFUSED("size", vlaprobe_stage_save(stage, &bytes, NULL, &error));
  REFUSED("stage", vlaprobe_stage_restore(NULL, hash, 1, &error));
  REFUSED("bytes", vlaprobe_stage_restore(stage, NULL, 1, &error));

  vlaprobe_policy* policy = NULL;
  REFUSED("text", vlaprobe_policy_create(NULL, &policy, &error));
  REFUSED("policy", vlaprobe_policy_create("null", NULL, &error));
  if (vlaprobe_policy_create("null", &policy, &error) != VLAPROBE_OK) exit(1);
  REFUSED("policy", vlaprobe_policy_begin(NULL, stage, 0, &error));
  REFUSED("stage", vlaprobe_policy_begin(policy, NULL, 0, &error));
  REFUSED("policy", vlaprobe_policy_act(NULL, stage, action, 7, &error));
  REFUSED("stage", vlaprobe_policy_act(policy, NULL, action, 7, &error));
  REFUSED("action", vlaprobe_policy_act(policy, stage, NULL, 7, &error));
  vlaprobe_policy_release(policy);
  vlaprobe_policy_release(NULL);
  vlaprobe_stage_release(stage);
  vlaprobe_stage_release(NULL);
}

static void of_batches(const vlaprobe_plan* plan, size_t task) {
  const vlaprobe_batch_options options = {.size = sizeof options, .no_pictures = 1, .worlds = 1};
  vlaprobe_batch* batch = NULL;
  REFUSED("plan", vlaprobe_batch_create(NULL, &task, 1, &options, &batch, &error));
  REFUSED("tasks", vlaprobe_batch_create(plan, NULL, 1, &options, &batch, &error));
  REFUSED("options", vlaprobe_batch_create(plan, &task, 1, NULL, &batch, &error));
  REFUSED("batch", vlaprobe_batch_create(plan, &task, 1, &options, NULL, &error));
  if (vlaprobe_batch_create(plan, &task, 1, &options, &batch, &error) != VLAPROBE_OK) exit(1);
  const vlaprobe_start start = {(int32_t)task, 0};
  const double action[VLAPROBE_ACTION_SIZE] = {0};
  vlaprobe_array array;
  char hash[65];
  REFUSED("batch", vlaprobe_batch_reset(NULL, NULL, &start, &error));
  REFUSED("starts", vlaprobe_batch_reset(batch, NULL, NULL, &error));
  REFUSED("batch", vlaprobe_batch_step(NULL, action, &start, &error));
  REFUSED("actions", vlaprobe_batch_step(batch, NULL, &start, &error));
  vlaprobe_action_space space;
  REFUSED("batch", vlaprobe_batch_action_space(NULL, &space, &error));
  REFUSED("out", vlaprobe_batch_action_space(batch, NULL, &error));
  REFUSED("batch", vlaprobe_batch_array(NULL, VLAPROBE_FIELD_STEPS, 0, &array, &error));
  REFUSED("out", vlaprobe_batch_array(batch, VLAPROBE_FIELD_STEPS, 0, NULL, &error));
  REFUSED("batch", vlaprobe_batch_final(NULL, VLAPROBE_FIELD_STEPS, 0, &array, &error));
  REFUSED("out", vlaprobe_batch_final(batch, VLAPROBE_FIELD_STEPS, 0, NULL, &error));
  EMPTY(vlaprobe_batch_fault(NULL, 0));
  EMPTY(vlaprobe_batch_camera(NULL, 0));
  EMPTY(vlaprobe_batch_metric(NULL, 0));
  EMPTY(vlaprobe_batch_metric_is_truth(NULL, 0));
  REFUSED("batch", vlaprobe_batch_hash(NULL, 0, hash, &error));
  REFUSED("hash", vlaprobe_batch_hash(batch, 0, NULL, &error));
  vlaprobe_batch_release(batch);
  vlaprobe_batch_release(NULL);
}

static void of_folders(const vlaprobe_plan* plan) {
  char* json = NULL;
  const char* names[] = {"success", NULL};
  const vlaprobe_run_options run = {.size = sizeof run, .out = "x", .policy = "null"};
  const vlaprobe_run_options no_seeds = {
      .size = sizeof run, .out = "x", .policy = "null", .seed_count = 1};
  const vlaprobe_ask_options ask = {.size = sizeof ask, .out = "x", .model = "truth"};
  const vlaprobe_report_options page = {.size = sizeof page, .out = "page.html"};
  REFUSED("plan", vlaprobe_run(NULL, &run, &json, &error));
  REFUSED("options", vlaprobe_run(plan, NULL, &json, &error));
  REFUSED("seeds", vlaprobe_run(plan, &no_seeds, &json, &error));
  REFUSED("plan", vlaprobe_ask(NULL, &ask, &json, &error));
  REFUSED("options", vlaprobe_ask(plan, NULL, &json, &error));
  REFUSED("folder", vlaprobe_answers(NULL, &json, &error));
  REFUSED("json", vlaprobe_answers("x", NULL, &error));
  REFUSED("folder", vlaprobe_why_answers(NULL, "x", 0, -1, NULL, &json, &error));
  REFUSED("task", vlaprobe_why_answers("x", NULL, 0, -1, NULL, &json, &error));
  REFUSED("json", vlaprobe_why_answers("x", "x", 0, -1, NULL, NULL, &error));
  REFUSED("folder", vlaprobe_results(NULL, &json, &error));
  REFUSED("json", vlaprobe_results("x", NULL, &error));
  REFUSED("folder", vlaprobe_why(NULL, "x", 0, -1, NULL, &json, &error));
  REFUSED("task", vlaprobe_why("x", NULL, 0, -1, NULL, &json, &error));
  REFUSED("json", vlaprobe_why("x", "x", 0, -1, NULL, NULL, &error));
  REFUSED("folder", vlaprobe_compare(NULL, "x", NULL, 0, &json, &error));
  REFUSED("other", vlaprobe_compare("x", NULL, NULL, 0, &json, &error));
  REFUSED("metrics", vlaprobe_compare("x", "y", NULL, 1, &json, &error));
  REFUSED("metrics", vlaprobe_compare("x", "y", names, 2, &json, &error));
  REFUSED("json", vlaprobe_compare("x", "y", NULL, 0, NULL, &error));
  REFUSED("folders", vlaprobe_report(NULL, 1, &page, &json, &error));
  REFUSED("folders", vlaprobe_report(names, 2, &page, &json, &error));
  REFUSED("options", vlaprobe_report(names, 1, NULL, &json, &error));
  REFUSED("folder", vlaprobe_replay(NULL, "x", 0, -1, NULL, &json, &error));
  REFUSED("task", vlaprobe_replay("x", NULL, 0, -1, NULL, &json, &error));
}

/* A size that ends within a field is no size of any header. */
static void of_sizes(const char* file) {
  vlaprobe_plan* plan = NULL;
  const vlaprobe_plan_options half = {.size = 7};
  if (vlaprobe_plan_open(file, &half, &plan, &error) != VLAPROBE_USAGE || plan != NULL ||
      strstr(error.message, "size") == NULL) {
    fprintf(stderr, "nulls.c: half a pointer is taken for options\n");
    exit(1);
  }
}

void nulls(vlaprobe_plan* plan, size_t task, const char* file) {
  of_plans(plan, file);
  REFUSED("tasks", vlaprobe_plan_load(plan, NULL, 1, &error));
  of_stages(plan, task);
  of_batches(plan, task);
  of_folders(plan);
  of_sizes(file);
  vlaprobe_plan_release(NULL);
  vlaprobe_error_clear(NULL);
  vlaprobe_free(NULL);
  vlaprobe_refuse(NULL, 0, "why");
  vlaprobe_reply_say(NULL, "words");
  vlaprobe_reply_refuse(NULL, "why");
  vlaprobe_error_clear(&error);
}
