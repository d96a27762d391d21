/* A program in C that knows vlaprobe.h alone: api_host PLAN ASSETS TASK MISTAKEN.probe FOLDER
 * Steps the task's first episode to its end and prints, a line each: the C library's sine as this
 * program sees it, before and after; the pictures' bytes; the verdicts and the state. Exits with 1
 * and a line number where something is not as vlaprobe.h says. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "nulls.h"
#include "vlaprobe.h"

#define CHECK(condition)                                                       \
  do {                                                                         \
    if (!(condition)) {                                                        \
      fprintf(stderr, "host.c:%d: %s; last error: %s\n", __LINE__, #condition, \
              error.message != NULL ? error.message : "none");                 \
      exit(1);                                                                 \
    }                                                                          \
  } while (0)

static vlaprobe_error error;

/* FNV-1a. */
static uint64_t hash(uint64_t before, const void* data, size_t size) {
  const unsigned char* bytes = data;
  for (size_t i = 0; i < size; ++i) before = (before ^ bytes[i]) * 1099511628211u;
  return before;
}
#define EMPTY_HASH 14695981039346656037u

static uint64_t sine_here(void) {
  uint64_t all = EMPTY_HASH;
  for (int i = 0; i < 4000; ++i) {
    volatile double x = 0.3 + 0.001 * i;
    double y = sin(x);
    all = hash(all, &y, sizeof y);
  }
  return all;
}

static int says(const char* words) {
  return error.message != NULL && strstr(error.message, words) != NULL;
}

static void bad_input(vlaprobe_plan* plan, const char* assets, size_t task) {
  vlaprobe_plan* none = NULL;
  vlaprobe_stage* stage = NULL;
  size_t found = 0;
  CHECK(vlaprobe_plan_open("/no/such.plan", NULL, &none, &error) == VLAPROBE_IO);
  CHECK(error.code == VLAPROBE_IO && says("/no/such.plan") && none == NULL);
  CHECK(strcmp(vlaprobe_code_word(error.code), "io") == 0);
  CHECK(strcmp(vlaprobe_code_word(77), "unknown") == 0);
  CHECK(vlaprobe_plan_from_bytes("no plan", 7, NULL, &none, &error) == VLAPROBE_PLAN);
  CHECK(vlaprobe_plan_find_task(plan, "carrot_on_plat", &found, &error) == VLAPROBE_USAGE);
  CHECK(says("carrot_on_plat") && says("did you mean `carrot_on_plate`?"));
  CHECK(vlaprobe_stage_create(plan, 100000, NULL, &stage, &error) == VLAPROBE_USAGE &&
        says("100000"));
  vlaprobe_stage_options options = {.size = 3};
  CHECK(vlaprobe_stage_create(plan, task, &options, &stage, &error) == VLAPROBE_USAGE &&
        says("size"));
  options = (vlaprobe_stage_options){.size = sizeof options, .width = 100};
  CHECK(vlaprobe_stage_create(plan, task, &options, &stage, &error) == VLAPROBE_USAGE);
  options = (vlaprobe_stage_options){.size = sizeof options, .width = -5, .height = 100};
  CHECK(vlaprobe_stage_create(plan, task, &options, &stage, &error) == VLAPROBE_USAGE &&
        says("-5"));
  /* Of a newer header: what is zero may be there. */
  struct {
    vlaprobe_stage_options known;
    int32_t later[4];
  } newer = {.known = {.size = sizeof newer, .no_pictures = 1}};
  CHECK(vlaprobe_stage_create(plan, task, &newer.known, &stage, &error) == VLAPROBE_OK);
  vlaprobe_stage_release(stage);
  newer.later[2] = 1;
  stage = NULL;
  CHECK(vlaprobe_stage_create(plan, task, &newer.known, &stage, &error) == VLAPROBE_USAGE &&
        says("older"));
  CHECK(stage == NULL);
  /* Without a place for the error the code alone tells. */
  CHECK(vlaprobe_plan_open("/no/such.plan", NULL, &none, NULL) == VLAPROBE_IO);

  vlaprobe_plan_options elsewhere = {.size = sizeof elsewhere, .assets = "/no/such/assets"};
  size_t size = 0;
  const void* bytes = vlaprobe_plan_bytes(plan, &size);
  CHECK(vlaprobe_plan_from_bytes(bytes, size, &elsewhere, &none, &error) == VLAPROBE_OK);
  CHECK(vlaprobe_stage_create(none, task, NULL, &stage, &error) == VLAPROBE_ASSET &&
        says("/no/such/assets"));
  vlaprobe_plan_release(none);
  (void)assets;
  vlaprobe_plan_release(NULL);
  vlaprobe_stage_release(NULL);
  vlaprobe_batch_release(NULL);
  vlaprobe_policy_release(NULL);
}

static void compiles(const char* file, const char* assets) {
  const vlaprobe_plan_options options = {.size = sizeof options, .assets = assets};
  vlaprobe_plan* plan = NULL;
  CHECK(vlaprobe_compile(&file, 1, &options, &plan, &error) == VLAPROBE_TEXT);
  CHECK(plan == NULL && says("error[P0402]") && strstr(error.diagnostics, "\"P0402\"") != NULL);
  vlaprobe_error_clear(&error);
  CHECK(error.message == NULL && error.diagnostics == NULL && error.code == VLAPROBE_OK);
  const char* missing = "/no/such.probe";
  CHECK(vlaprobe_compile(&missing, 1, &options, &plan, &error) == VLAPROBE_IO &&
        says("/no/such.probe"));
  CHECK(error.diagnostics == NULL);
}

/* Reaches out while it goes down, then closes the gripper and goes up. */
static void act(int step, int horizon, double action[VLAPROBE_ACTION_SIZE]) {
  const int down = step < horizon / 2;
  const double numbers[VLAPROBE_ACTION_SIZE] = {
      down ? 0.005 : 0, 0, down ? -0.01 : 0.01, 0, 0, 0.02, down ? 1 : -1};
  memcpy(action, numbers, sizeof numbers);
}

static void one_episode(const vlaprobe_plan* plan, size_t task) {
  const vlaprobe_stage_options options = {.size = sizeof options, .width = 160, .height = 120};
  vlaprobe_stage *stage = NULL, *other = NULL;
  CHECK(vlaprobe_stage_create(plan, task, &options, &stage, &error) == VLAPROBE_OK);
  vlaprobe_state state;
  double action[VLAPROBE_ACTION_SIZE] = {0};
  CHECK(vlaprobe_stage_step(stage, action, 7, &error) == VLAPROBE_USAGE && says("reset first"));
  CHECK(vlaprobe_stage_state(stage, &state, &error) == VLAPROBE_USAGE);
  CHECK(vlaprobe_stage_reset(stage, 24, &error) == VLAPROBE_USAGE && says("no episode 24"));
  CHECK(vlaprobe_stage_reset(stage, 0, &error) == VLAPROBE_OK);
  CHECK(vlaprobe_stage_step(stage, action, 6, &error) == VLAPROBE_USAGE &&
        says("7 numbers, found 6"));
  action[3] = NAN;
  CHECK(vlaprobe_stage_step(stage, action, 7, &error) == VLAPROBE_USAGE && says("number 3"));
  action[3] = 4000;
  CHECK(vlaprobe_stage_step(stage, action, 7, &error) == VLAPROBE_USAGE && says("number 3"));
  vlaprobe_array picture;
  CHECK(vlaprobe_stage_picture(stage, 0, VLAPROBE_RGB, &picture, &error) == VLAPROBE_USAGE);

  uint64_t pictures = EMPTY_HASH;
  const void* bytes = NULL;
  size_t size = 0;
  for (;;) {
    CHECK(vlaprobe_stage_state(stage, &state, &error) == VLAPROBE_OK);
    if (state.terminated || state.truncated) break;
    CHECK(vlaprobe_stage_observe(stage, &error) == VLAPROBE_OK);
    CHECK(vlaprobe_stage_picture(stage, 1, VLAPROBE_RGB, &picture, &error) == VLAPROBE_USAGE);
    CHECK(vlaprobe_stage_picture(stage, 0, VLAPROBE_DEPTH, &picture, &error) == VLAPROBE_OK);
    CHECK(picture.type == VLAPROBE_F32 && picture.rank == 2 && picture.shape[0] == 120 &&
          picture.shape[1] == 160);
    CHECK(vlaprobe_stage_picture(stage, 0, VLAPROBE_RGB, &picture, &error) == VLAPROBE_OK);
    CHECK(picture.type == VLAPROBE_U8 && picture.rank == 3 && picture.shape[2] == 3 &&
          picture.shape[3] == 1);
    pictures = hash(pictures, picture.data, 120 * 160 * 3);
    act(state.steps, state.horizon, action);
    if (state.steps == 10) {
      CHECK(vlaprobe_stage_save(stage, &bytes, &size, &error) == VLAPROBE_OK);
      CHECK(vlaprobe_stage_create(plan, task, &options, &other, &error) == VLAPROBE_OK);
      CHECK(vlaprobe_stage_restore(other, bytes, size - 1, &error) == VLAPROBE_WORLD);
      CHECK(vlaprobe_stage_step(other, action, 7, &error) == VLAPROBE_USAGE);
      CHECK(vlaprobe_stage_restore(other, bytes, size, &error) == VLAPROBE_OK);
    }
    CHECK(vlaprobe_stage_step(stage, action, 7, &error) == VLAPROBE_OK);
    if (state.steps >= 10) CHECK(vlaprobe_stage_step(other, action, 7, &error) == VLAPROBE_OK);
  }
  CHECK(state.truncated && state.steps == state.horizon && state.success == 0);
  CHECK(vlaprobe_stage_step(stage, action, 7, &error) == VLAPROBE_USAGE && says("over"));
  char here[65], there[65];
  CHECK(vlaprobe_stage_hash(stage, here, &error) == VLAPROBE_OK);
  CHECK(vlaprobe_stage_hash(other, there, &error) == VLAPROBE_OK);
  CHECK(strcmp(here, there) == 0);
  CHECK(state.joints.rank == 1 && state.joints.type == VLAPROBE_F64 && state.objects.shape[1] == 7);
  CHECK(strcmp(vlaprobe_stage_object(stage, 0), "carrot") == 0);
  CHECK(vlaprobe_stage_object(stage, (size_t)state.objects.shape[0]) == NULL);
  printf("pictures %016llx\n", (unsigned long long)pictures);
  for (int64_t m = 0; m < state.metrics.shape[0]; ++m) {
    printf("%s %g, ", vlaprobe_stage_metric(stage, (size_t)m),
           ((const double*)state.metrics.data)[m]);
  }
  printf("%d steps, state %s\n", state.steps, here);
  vlaprobe_stage_release(other);
  vlaprobe_stage_release(stage);
}

/* The same episode in one world of three, beside others. */
static void three_worlds(const vlaprobe_plan* plan, size_t task, int32_t autoreset) {
  const vlaprobe_batch_options options = {.size = sizeof options,
                                          .width = 160,
                                          .height = 120,
                                          .worlds = 3,
                                          .threads = 2,
                                          .autoreset = autoreset};
  vlaprobe_batch* batch = NULL;
  CHECK(vlaprobe_batch_create(plan, &task, 1, &options, &batch, &error) == VLAPROBE_OK);
  vlaprobe_start starts[3] = {{(int32_t)task, 3}, {(int32_t)task, 0}, {(int32_t)task, 5}};
  const vlaprobe_start next[3] = {{(int32_t)task, 7}, {(int32_t)task, 8}, {(int32_t)task, 9}};
  double actions[3][VLAPROBE_ACTION_SIZE];
  memset(actions, 0, sizeof actions);
  CHECK(vlaprobe_batch_step(batch, &actions[0][0], next, &error) == VLAPROBE_USAGE &&
        says("world 0"));
  starts[2].episode = 99;
  CHECK(vlaprobe_batch_reset(batch, NULL, starts, &error) == VLAPROBE_USAGE && says("world 2") &&
        says("99"));
  starts[2].episode = 5;
  CHECK(vlaprobe_batch_reset(batch, NULL, starts, &error) == VLAPROBE_OK);
  actions[1][6] = INFINITY;
  CHECK(vlaprobe_batch_step(batch, &actions[0][0], next, &error) == VLAPROBE_USAGE &&
        says("world 1"));
  vlaprobe_array rgb, truncated, steps, episode, begun;
  uint64_t pictures = EMPTY_HASH;
  for (int step = 0; step < 60; ++step) {
    CHECK(vlaprobe_batch_array(batch, VLAPROBE_FIELD_STEPS, 0, &steps, &error) == VLAPROBE_OK);
    CHECK(((const int32_t*)steps.data)[1] == step);
    CHECK(vlaprobe_batch_array(batch, VLAPROBE_FIELD_RGB, 0, &rgb, &error) == VLAPROBE_OK);
    CHECK(rgb.rank == 4 && rgb.shape[0] == 3 && rgb.shape[1] == 120);
    pictures = hash(pictures, (const unsigned char*)rgb.data + 120 * 160 * 3, 120 * 160 * 3);
    for (int world = 0; world < 3; ++world) act(step, 60, actions[world]);
    CHECK(vlaprobe_batch_step(batch, &actions[0][0], next, &error) == VLAPROBE_OK);
    CHECK(vlaprobe_batch_fault(batch, 1) == NULL);
  }
  CHECK(vlaprobe_batch_array(batch, VLAPROBE_FIELD_TRUNCATED, 0, &truncated, &error) ==
        VLAPROBE_OK);
  CHECK(((const uint8_t*)truncated.data)[1] == 1);
  CHECK(vlaprobe_batch_array(batch, VLAPROBE_FIELD_EPISODE, 0, &episode, &error) == VLAPROBE_OK);
  const int32_t shown = ((const int32_t*)episode.data)[1];
  if (autoreset == VLAPROBE_SAME_STEP) {
    CHECK(shown == 8);
    CHECK(vlaprobe_batch_final(batch, VLAPROBE_FIELD_EPISODE, 0, &episode, &error) == VLAPROBE_OK);
    CHECK(((const int32_t*)episode.data)[1] == 0);
  } else {
    CHECK(shown == 0);
    CHECK(vlaprobe_batch_final(batch, VLAPROBE_FIELD_EPISODE, 0, &episode, &error) ==
          VLAPROBE_USAGE);
    char state[65];
    CHECK(vlaprobe_batch_hash(batch, 1, state, &error) == VLAPROBE_OK);
    printf("batch %016llx state %s\n", (unsigned long long)pictures, state);
  }
  const int32_t again = vlaprobe_batch_step(batch, &actions[0][0], next, &error);
  if (autoreset == VLAPROBE_DISABLED) {
    CHECK(again == VLAPROBE_USAGE && says("world 0") && says("over"));
    const uint8_t mask[3] = {0, 1, 0};
    CHECK(vlaprobe_batch_reset(batch, mask, next, &error) == VLAPROBE_OK);
  } else {
    CHECK(again == VLAPROBE_OK);
  }
  CHECK(vlaprobe_batch_array(batch, VLAPROBE_FIELD_EPISODE, 0, &episode, &error) == VLAPROBE_OK);
  CHECK(((const int32_t*)episode.data)[1] == 8);
  CHECK(vlaprobe_batch_array(batch, VLAPROBE_FIELD_STEPS, 0, &steps, &error) == VLAPROBE_OK);
  CHECK(((const int32_t*)steps.data)[1] == (autoreset == VLAPROBE_SAME_STEP ? 1 : 0));
  CHECK(vlaprobe_batch_array(batch, VLAPROBE_FIELD_BEGUN, 0, &begun, &error) == VLAPROBE_OK);
  CHECK(((const uint8_t*)begun.data)[1] == (autoreset == VLAPROBE_SAME_STEP ? 0 : 1));
  vlaprobe_batch_release(batch);
}

/* The expert solves it, through the interface. */
static void expert(const vlaprobe_plan* plan, size_t task) {
  const vlaprobe_stage_options options = {.size = sizeof options, .no_pictures = 1};
  vlaprobe_stage* stage = NULL;
  vlaprobe_policy* policy = NULL;
  double action[VLAPROBE_ACTION_SIZE];
  CHECK(vlaprobe_policy_create("expart", &policy, &error) == VLAPROBE_USAGE && says("expert"));
  CHECK(vlaprobe_policy_create("expert", &policy, &error) == VLAPROBE_OK);
  CHECK(vlaprobe_stage_create(plan, task, &options, &stage, &error) == VLAPROBE_OK);
  CHECK(vlaprobe_policy_begin(policy, stage, 0, &error) == VLAPROBE_USAGE && says("reset first"));
  CHECK(vlaprobe_policy_act(policy, stage, action, 7, &error) == VLAPROBE_USAGE);
  CHECK(vlaprobe_stage_reset(stage, 3, &error) == VLAPROBE_OK);
  CHECK(vlaprobe_stage_observe(stage, &error) == VLAPROBE_USAGE && says("without pictures"));
  CHECK(vlaprobe_policy_begin(policy, stage, 0, &error) == VLAPROBE_OK);
  vlaprobe_action_space space = {0};
  CHECK(vlaprobe_stage_action_space(stage, &space, &error) == VLAPROBE_OK);
  CHECK(space.kind == VLAPROBE_TOOL && space.size == VLAPROBE_ACTION_SIZE);
  CHECK(vlaprobe_policy_act(policy, stage, action, 6, &error) == VLAPROBE_USAGE && says("6"));
  vlaprobe_state state = {0};
  while (!state.truncated) {
    CHECK(vlaprobe_policy_act(policy, stage, action, 7, &error) == VLAPROBE_OK);
    CHECK(vlaprobe_stage_step(stage, action, 7, &error) == VLAPROBE_OK);
    CHECK(vlaprobe_stage_state(stage, &state, &error) == VLAPROBE_OK);
  }
  CHECK(state.success == 1);
  /* What it keeps is of the episode that it began. */
  CHECK(vlaprobe_stage_reset(stage, 4, &error) == VLAPROBE_OK);
  CHECK(vlaprobe_policy_act(policy, stage, action, 7, &error) == VLAPROBE_USAGE && says("begin"));
  CHECK(vlaprobe_policy_begin(policy, stage, 0, &error) == VLAPROBE_OK);
  CHECK(vlaprobe_policy_act(policy, stage, action, 7, &error) == VLAPROBE_OK);
  const void* bytes = NULL;
  size_t size = 0;
  CHECK(vlaprobe_stage_save(stage, &bytes, &size, &error) == VLAPROBE_OK);
  CHECK(vlaprobe_policy_act(policy, stage, action, 7, &error) == VLAPROBE_OK);
  CHECK(vlaprobe_stage_restore(stage, bytes, size, &error) == VLAPROBE_OK);
  CHECK(vlaprobe_policy_act(policy, stage, action, 7, &error) == VLAPROBE_USAGE && says("restored"));
  CHECK(vlaprobe_policy_begin(policy, stage, 0, &error) == VLAPROBE_OK);
  /* The policy was told where the robot's numbers are; the stage goes first all the same. */
  vlaprobe_stage* other = NULL;
  CHECK(vlaprobe_stage_create(plan, task, &options, &other, &error) == VLAPROBE_OK);
  CHECK(vlaprobe_stage_reset(other, 3, &error) == VLAPROBE_OK);
  vlaprobe_stage_release(stage);
  CHECK(vlaprobe_policy_act(policy, other, action, 7, &error) == VLAPROBE_USAGE && says("begin"));
  vlaprobe_policy_release(policy);
  vlaprobe_stage_release(other);
}

/* Stands still with an open gripper; refuses what it is asked of episode 1. */
static void stand_still(void* user, const vlaprobe_question* questions, size_t count,
                        double* actions, vlaprobe_refusals* refusals) {
  ++*(int*)user;
  for (size_t i = 0; i < count; ++i) {
    for (int k = 0; k < VLAPROBE_ACTION_SIZE; ++k)
      actions[i * VLAPROBE_ACTION_SIZE + (size_t)k] = k == 6 ? 1 : 0;
    if (questions[i].episode == 1) vlaprobe_refuse(refusals, i, "not this one");
  }
}
static int32_t only_one(void* user, const vlaprobe_progress* progress) {
  (void)user;
  return progress->done == 1;
}

static void runs(const vlaprobe_plan* plan, const char* task, const char* folder) {
  char still[1000], expert[1000], page[1000];
  snprintf(still, sizeof still, "%s/still", folder);
  snprintf(expert, sizeof expert, "%s/expert", folder);
  snprintf(page, sizeof page, "%s/page.html", folder);
  char* json = NULL;
  int calls = 0;
  vlaprobe_run_options options = {.size = sizeof options,
                                  .out = still,
                                  .tasks = task,
                                  .has_episodes = 1,
                                  .last_episode = 1,
                                  .jobs = 2,
                                  .act = &stand_still,
                                  .user = &calls};
  CHECK(vlaprobe_run(plan, &options, &json, &error) == VLAPROBE_USAGE && says("name"));
  options.name = "still";
  CHECK(vlaprobe_run(plan, &options, &json, &error) == VLAPROBE_OK);
  CHECK(strstr(json, "\"done\":2") != NULL && strstr(json, "\"invalid\":1") != NULL && calls > 0);
  vlaprobe_free(json);
  CHECK(vlaprobe_results(still, &json, &error) == VLAPROBE_OK);
  CHECK(strstr(json, "policy: not this one") != NULL && strstr(json, "\"refused\":[]") != NULL);
  vlaprobe_free(json);
  CHECK(vlaprobe_results("/no/such/run", &json, &error) == VLAPROBE_STORE && says("/no/such/run"));

  options.until = "width 200%";
  CHECK(vlaprobe_run(plan, &options, &json, &error) == VLAPROBE_USAGE && says("width"));
  options = (vlaprobe_run_options){.size = sizeof options,
                                   .out = expert,
                                   .policy = "expert",
                                   .tasks = task,
                                   .has_episodes = 1,
                                   .last_episode = 1,
                                   .progress = &only_one};
  CHECK(vlaprobe_run(plan, &options, NULL, &error) == VLAPROBE_STOPPED && says("continues"));
  options.progress = NULL;
  CHECK(vlaprobe_run(plan, &options, &json, &error) == VLAPROBE_OK);
  CHECK(strstr(json, "\"done\":1") != NULL && strstr(json, "\"skipped\":1") != NULL);
  vlaprobe_free(json);
  CHECK(vlaprobe_why(expert, task, 0, -1, "success", &json, &error) == VLAPROBE_OK);
  CHECK(strstr(json, "\"value\":true") != NULL);
  vlaprobe_free(json);
  CHECK(vlaprobe_why(expert, task, 7, -1, NULL, &json, &error) == VLAPROBE_USAGE);
  CHECK(vlaprobe_replay(expert, task, 0, -1, NULL, &json, &error) == VLAPROBE_OK);
  CHECK(strstr(json, "\"identical\":true") != NULL);
  vlaprobe_free(json);
  CHECK(vlaprobe_compare(expert, still, NULL, 0, &json, &error) == VLAPROBE_OK);
  CHECK(strstr(json, "\"words\"") != NULL);
  vlaprobe_free(json);
  CHECK(vlaprobe_compare(expert, expert, NULL, 0, &json, &error) == VLAPROBE_USAGE &&
        says("twice"));
  const vlaprobe_report_options wanted = {.size = sizeof wanted, .out = page, .title = "two runs"};
  /* This plan asks nothing. */
  vlaprobe_ask_options asking = {.size = sizeof asking, .model = "truth"};
  CHECK(vlaprobe_ask(plan, &asking, &json, &error) == VLAPROBE_USAGE && says("out"));
  asking.out = page;
  CHECK(vlaprobe_ask(plan, &asking, &json, &error) == VLAPROBE_USAGE && says("questions"));
  CHECK(vlaprobe_answers(expert, &json, &error) == VLAPROBE_STORE);
  const char* folders[] = {expert, still};
  CHECK(vlaprobe_report(folders, 2, &wanted, &json, &error) == VLAPROBE_OK);
  CHECK(strstr(json, "\"policies\":2") != NULL);
  vlaprobe_free(json);
}

int main(int count, char** words) {
  if (count != 6) return 2;
  const vlaprobe_plan_options options = {.size = sizeof options, .assets = words[2]};
  CHECK(vlaprobe_api_version() == VLAPROBE_API_VERSION);
  printf("sine %016llx\n", (unsigned long long)sine_here());
  vlaprobe_plan* plan = NULL;
  CHECK(vlaprobe_plan_open(words[1], &options, &plan, &error) == VLAPROBE_OK);
  size_t task = 0;
  CHECK(vlaprobe_plan_find_task(plan, words[3], &task, &error) == VLAPROBE_OK);
  vlaprobe_task about;
  CHECK(vlaprobe_plan_task(plan, task, &about, &error) == VLAPROBE_OK);
  CHECK(strcmp(about.name, words[3]) == 0 && about.episodes == 24 && about.horizon == 60 &&
        about.cameras == 1);
  vlaprobe_episode episode;
  vlaprobe_placement placement;
  CHECK(vlaprobe_plan_episode(plan, task, 3, &episode, &error) == VLAPROBE_OK);
  CHECK(strlen(episode.episode_id) == 64 && episode.placements == 2);
  CHECK(vlaprobe_plan_placement(plan, task, 3, 0, &placement, &error) == VLAPROBE_OK);
  CHECK(strcmp(placement.object, "carrot") == 0);
  CHECK(vlaprobe_plan_placement(plan, task, 3, 2, &placement, &error) == VLAPROBE_USAGE);
  char* json = NULL;
  CHECK(vlaprobe_plan_describe(plan, task, &json, &error) == VLAPROBE_OK &&
        strstr(json, "\"prompt\"") != NULL);
  vlaprobe_free(json);
  bad_input(plan, words[2], task);
  nulls(plan, task, words[1]);
  compiles(words[4], words[2]);
  one_episode(plan, task);
  three_worlds(plan, task, VLAPROBE_NEXT_STEP);
  three_worlds(plan, task, VLAPROBE_SAME_STEP);
  three_worlds(plan, task, VLAPROBE_DISABLED);
  expert(plan, task);
  runs(plan, words[3], words[5]);
  /* A stage outlives the handle of its plan. */
  vlaprobe_stage* stage = NULL;
  const vlaprobe_stage_options blind = {.size = sizeof blind, .no_pictures = 1};
  CHECK(vlaprobe_stage_create(plan, task, &blind, &stage, &error) == VLAPROBE_OK);
  vlaprobe_plan_forget(plan);
  vlaprobe_plan_release(plan);
  CHECK(vlaprobe_stage_reset(stage, 1, &error) == VLAPROBE_OK);
  vlaprobe_stage_release(stage);
  vlaprobe_error_clear(&error);
  printf("sine %016llx\n", (unsigned long long)sine_here());
  return 0;
}
