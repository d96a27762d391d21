/* vlaprobe as a library: plans, worlds that step, policies. C11 and C++; libvlaprobe.so exports
 * what is here and no more.
 *
 * Calls. A function that can fail returns VLAPROBE_OK or a vlaprobe_code and then says why in
 * `error`, which may be NULL. Nothing else tells of a failure: nothing is printed, no exception
 * crosses, no state is global. What a function gives through a pointer is written only where it
 * returns VLAPROBE_OK.
 *
 * NULL. Where a comment does not say what it means, a handle or an argument that is NULL is
 * VLAPROBE_USAGE, and named; an array of no elements may be NULL. `error`, and a `char **` beside a
 * result that is stored in a folder, may be NULL. Functions without a code give NULL or 0 of a
 * handle that is NULL.
 *
 * Ownership. A handle is released with its own function, once, as memory is by free(); releasing
 * NULL does nothing. What a handle was made of may be released before it. Strings are UTF-8 and end
 * with a zero byte. Arrays and strings that a handle gives are its own and stay until the next call
 * with that handle that is not one of its questions (those take it as const); what is given as
 * `char **` is the caller's, for vlaprobe_free().
 *
 * Threads. A plan may be used by any number of threads at a time. Any other handle is used by one
 * thread at a time; a second one that comes is refused (VLAPROBE_USAGE). Worlds, batches and
 * policies do not survive a fork(): in the child they are refused, and can only be left alone.
 *
 * Units and frames. Metres, radians, seconds; right-handed; world frame with z up unless a comment
 * says otherwise. Quaternions are w x y z. Pictures are rows from the top, pixels of red, green,
 * blue.
 */
#ifndef VLAPROBE_H
#define VLAPROBE_H

#include <stddef.h>
#include <stdint.h>

#if defined(VLAPROBE_BUILDING)
#define VLAPROBE_EXPORT __attribute__((visibility("default")))
#else
#define VLAPROBE_EXPORT
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Raised when something here changes so that a program has to; options only grow (their `size` says
 * by how much). */
#define VLAPROBE_API_VERSION 1
VLAPROBE_EXPORT int32_t vlaprobe_api_version(void);
/* "0.1.0" */
VLAPROBE_EXPORT const char* vlaprobe_version(void);

/* ---- errors */

typedef enum vlaprobe_code {
  VLAPROBE_OK = 0,
  VLAPROBE_USAGE = 1,     /* what was asked for: an argument, a name, a file's content */
  VLAPROBE_IO = 2,        /* a file or a stream cannot be read or written */
  VLAPROBE_PLAN = 3,      /* a plan breaks a rule of its format */
  VLAPROBE_ASSET = 4,     /* a mesh, a picture or a folder of them */
  VLAPROBE_URDF = 5,      /* a robot's description */
  VLAPROBE_WORLD = 6,     /* the simulation cannot go on */
  VLAPROBE_JUDGE = 7,     /* a metric cannot be computed */
  VLAPROBE_RENDER = 8,    /* a picture cannot be drawn */
  VLAPROBE_POLICY = 9,    /* a policy, or the wire to its server */
  VLAPROBE_ANSWERED = 10, /* a server is there and says no */
  VLAPROBE_STORE = 11,    /* the folder of a run */
  VLAPROBE_TRACE = 12,    /* a stored episode */
  VLAPROBE_VIDEO = 13,    /* an encoder */
  VLAPROBE_CLUSTER = 14,  /* Slurm */
  VLAPROBE_STATS = 15,    /* an estimate that does not exist */
  VLAPROBE_TABLE = 16,    /* a published table */
  VLAPROBE_INTERNAL = 17, /* a mistake of ours */
  VLAPROBE_NO_SKILL = 18, /* a policy of the library's has no skill for what the task asks */
  VLAPROBE_TEXT = 100,    /* the user's .probe text has mistakes: see `diagnostics` */
  VLAPROBE_MEMORY = 101,  /* there is none left */
  VLAPROBE_STOPPED = 102  /* a callback asked for the end */
} vlaprobe_code;

/* Zero it before its first use; a function that fails writes it, and frees what an earlier one
 * wrote. */
typedef struct vlaprobe_error {
  int32_t code; /* vlaprobe_code */
  char*
      message; /* names the thing and the place: "PLACE: what is wrong", or rendered diagnostics */
  char* where; /* the place alone, "" where the message says it */
  char* diagnostics; /* of VLAPROBE_TEXT: a JSON array as `vlaprobe check --json` prints it; else
                        NULL */
} vlaprobe_error;
VLAPROBE_EXPORT void vlaprobe_error_clear(vlaprobe_error* error);
/* "usage", "io", ... ; "unknown" for a number that is no code. */
VLAPROBE_EXPORT const char* vlaprobe_code_word(int32_t code);

VLAPROBE_EXPORT void vlaprobe_free(void* memory);

/* ---- numbers */

typedef enum vlaprobe_type {
  VLAPROBE_U8 = 1,
  VLAPROBE_U16 = 2,
  VLAPROBE_I32 = 3,
  VLAPROBE_F32 = 4,
  VLAPROBE_F64 = 5
} vlaprobe_type;

/* Contiguous, the last index fastest. Dimensions behind `rank` are 1. */
typedef struct vlaprobe_array {
  const void* data;
  int32_t type; /* vlaprobe_type */
  int32_t rank;
  int64_t shape[4];
} vlaprobe_array;

/* x y z of a translation (m), x y z of a rotation vector (rad), both in the robot's base frame, and
 * the gripper from -1 closed to 1 open: the numbers of a robot whose tool is moved. Others say in
 * their vlaprobe_action_space how many they take. */
#define VLAPROBE_ACTION_SIZE 7

typedef enum vlaprobe_action_kind {
  VLAPROBE_TOOL = 1,           /* VLAPROBE_ACTION_SIZE numbers */
  VLAPROBE_JOINT_STEPS = 2,    /* a step of each arm joint (rad, m), and the gripper */
  VLAPROBE_JOINT_POSITIONS = 3 /* a position of each arm joint (rad, m), and the gripper */
} vlaprobe_action_kind;
typedef struct vlaprobe_action_space {
  int32_t kind; /* vlaprobe_action_kind */
  int32_t size; /* numbers of an action */
  /* F64 (size): between these actions are usual; of positions the joints' limits, and pi to either
   * side where there are none. */
  vlaprobe_array low, high;
} vlaprobe_action_space;

/* ---- plans */

typedef struct vlaprobe_plan vlaprobe_plan;

/* NULL and 0 are the defaults. */
typedef struct vlaprobe_plan_options {
  uint32_t size; /* sizeof(vlaprobe_plan_options) */
  /* Folders of meshes and robots, one a line; default: beside the texts, then VLAPROBE_ASSETS, else
   * beside the library. */
  const char* assets;
  const char* library; /* folder that holds std/; default: VLAPROBE_STD, else beside the library */
  const char* suite;   /* the one suite to compile; default: all */
  const char* tasks;   /* glob over tasks: only these are compiled; default: all */
} vlaprobe_plan_options;

/* Compiles .probe files as `vlaprobe build` does. Fails with VLAPROBE_TEXT where the text has
 * mistakes. */
VLAPROBE_EXPORT int32_t vlaprobe_compile(const char* const* files, size_t count,
                                         const vlaprobe_plan_options* options, vlaprobe_plan** plan,
                                         vlaprobe_error* error);
/* Opens and verifies a .plan file, or its bytes, which are copied. Of the options only `assets` is
 * read. */
VLAPROBE_EXPORT int32_t vlaprobe_plan_open(const char* path, const vlaprobe_plan_options* options,
                                           vlaprobe_plan** plan, vlaprobe_error* error);
VLAPROBE_EXPORT int32_t vlaprobe_plan_from_bytes(const void* bytes, size_t size,
                                                 const vlaprobe_plan_options* options,
                                                 vlaprobe_plan** plan, vlaprobe_error* error);
VLAPROBE_EXPORT void vlaprobe_plan_release(vlaprobe_plan* plan);

/* The content address, 64 hexadecimal digits. */
VLAPROBE_EXPORT const char* vlaprobe_plan_root(const vlaprobe_plan* plan);
/* The folders that its files are taken from, one a line, as an option `assets` takes them: those
 * that were named and those beside its texts; "" where only those found by themselves are needed. */
VLAPROBE_EXPORT const char* vlaprobe_plan_assets(const vlaprobe_plan* plan);
/* The plan as a file has it. */
VLAPROBE_EXPORT const void* vlaprobe_plan_bytes(const vlaprobe_plan* plan, size_t* size);
/* Warnings of the compiler for people, "" where there are none, and as a JSON array. */
VLAPROBE_EXPORT const char* vlaprobe_plan_warnings(const vlaprobe_plan* plan);
VLAPROBE_EXPORT const char* vlaprobe_plan_diagnostics(const vlaprobe_plan* plan);

typedef struct vlaprobe_task {
  const char* name;
  const char* instruction; /* what a policy is told, at first where it changes */
  int64_t baseline;        /* the task that this one is a variant of, -1 of none */
  int32_t episodes;        /* starts, numbered from 0 */
  int32_t horizon;         /* control steps */
  double control_hz;       /* control steps a second */
  int32_t cameras;
  int32_t joints; /* of the robot */
} vlaprobe_task;

VLAPROBE_EXPORT size_t vlaprobe_plan_task_count(const vlaprobe_plan* plan);
VLAPROBE_EXPORT int32_t vlaprobe_plan_task(const vlaprobe_plan* plan, size_t task,
                                           vlaprobe_task* out, vlaprobe_error* error);
/* By name, with or without its suite's prefix. */
VLAPROBE_EXPORT int32_t vlaprobe_plan_find_task(const vlaprobe_plan* plan, const char* name,
                                                size_t* task, vlaprobe_error* error);
/* What `vlaprobe show PLAN TASK --json` prints. */
VLAPROBE_EXPORT int32_t vlaprobe_plan_describe(const vlaprobe_plan* plan, size_t task, char** json,
                                               vlaprobe_error* error);
/* What `vlaprobe list PLAN --json` prints: one object a task. */
VLAPROBE_EXPORT int32_t vlaprobe_plan_list(const vlaprobe_plan* plan, char** json,
                                           vlaprobe_error* error);

typedef struct vlaprobe_suite {
  const char* name;
  const char* prefix; /* may stand before its tasks' names */
  const uint32_t* tasks;
  size_t task_count;
  const uint32_t* seeds;
  size_t seed_count;
} vlaprobe_suite;
VLAPROBE_EXPORT size_t vlaprobe_plan_suite_count(const vlaprobe_plan* plan);
VLAPROBE_EXPORT int32_t vlaprobe_plan_suite(const vlaprobe_plan* plan, size_t suite,
                                            vlaprobe_suite* out, vlaprobe_error* error);

/* Where an object is put before it falls and settles: its model frame in world. */
typedef struct vlaprobe_placement {
  const char* object;
  double position[3];
  double rotation[4];
} vlaprobe_placement;
typedef struct vlaprobe_episode {
  char episode_id[65]; /* equal where task, start, words, rule and all else are: hexadecimal */
  char start_id[65];   /* equal where the start is */
  int32_t placements;
} vlaprobe_episode;
VLAPROBE_EXPORT int32_t vlaprobe_plan_episode(const vlaprobe_plan* plan, size_t task,
                                              int32_t episode, vlaprobe_episode* out,
                                              vlaprobe_error* error);
VLAPROBE_EXPORT int32_t vlaprobe_plan_placement(const vlaprobe_plan* plan, size_t task,
                                                int32_t episode, int32_t placement,
                                                vlaprobe_placement* out, vlaprobe_error* error);

/* Reads the files that these tasks need, so that the first world of each is made quickly. A plan
 * keeps what was read for its worlds until it is released or told to forget it; worlds that are
 * there keep theirs. */
VLAPROBE_EXPORT int32_t vlaprobe_plan_load(vlaprobe_plan* plan, const size_t* tasks, size_t count,
                                           vlaprobe_error* error);
VLAPROBE_EXPORT void vlaprobe_plan_forget(vlaprobe_plan* plan);

/* ---- a world that steps */

typedef struct vlaprobe_stage vlaprobe_stage;

typedef struct vlaprobe_stage_options {
  uint32_t size;         /* sizeof(vlaprobe_stage_options) */
  int32_t width, height; /* of every camera's picture; 0: the camera's own */
  int32_t no_pictures;   /* 1: none are drawn, and nothing of them is set up */
} vlaprobe_stage_options;

/* `options` may be NULL. The stage has no episode before its first reset or restore. */
VLAPROBE_EXPORT int32_t vlaprobe_stage_create(const vlaprobe_plan* plan, size_t task,
                                              const vlaprobe_stage_options* options,
                                              vlaprobe_stage** stage, vlaprobe_error* error);
VLAPROBE_EXPORT void vlaprobe_stage_release(vlaprobe_stage* stage);

/* Begins an episode: objects fall from the start's placements and settle. Fails with VLAPROBE_WORLD
 * where the instruction does not hold of the settled start, as a run calls such an episode invalid.
 */
VLAPROBE_EXPORT int32_t vlaprobe_stage_reset(vlaprobe_stage* stage, int32_t episode,
                                             vlaprobe_error* error);
/* What its robot's actions are; the arrays are the stage's. */
VLAPROBE_EXPORT int32_t vlaprobe_stage_action_space(const vlaprobe_stage* stage,
                                                    vlaprobe_action_space* out,
                                                    vlaprobe_error* error);
/* One control step of `size` numbers. Fails with VLAPROBE_USAGE on another size than its action
 * space's, a number that is not finite, and after the horizon or where nothing was reset; then
 * nothing has changed. After any other failure only a reset or restore is accepted. */
VLAPROBE_EXPORT int32_t vlaprobe_stage_step(vlaprobe_stage* stage, const double* action,
                                            size_t size, vlaprobe_error* error);

typedef struct vlaprobe_state {
  int32_t episode;
  int32_t steps; /* control steps done */
  int32_t horizon;
  int32_t terminated; /* what the task's text ends episodes by holds */
  int32_t truncated;  /* the horizon is reached */
  int32_t decided;    /* no verdict can change any more */
  int32_t success;    /* the metric of that name; 0 where there is none */
  double tool[7];     /* position and rotation of the tool centre point in the robot's base frame */
  double openness;    /* of the gripper: 0 closed .. 1 open */
  vlaprobe_array joints;  /* F64 (n): the robot's, rad and m, in the plan's drive order */
  vlaprobe_array metrics; /* F64 (m): verdicts and measures so far, truths 0 or 1 */
  vlaprobe_array objects; /* F64 (k, 7): position and rotation of the objects' model frames */
} vlaprobe_state;
VLAPROBE_EXPORT int32_t vlaprobe_stage_state(const vlaprobe_stage* stage, vlaprobe_state* out,
                                             vlaprobe_error* error);
/* Of everything that moves, 64 hexadecimal digits and a zero byte: equal states, equal hashes, as
 * traces have them. */
VLAPROBE_EXPORT int32_t vlaprobe_stage_hash(const vlaprobe_stage* stage, char hash[65],
                                            vlaprobe_error* error);

/* Draws what every camera sees now. */
VLAPROBE_EXPORT int32_t vlaprobe_stage_observe(vlaprobe_stage* stage, vlaprobe_error* error);
typedef enum vlaprobe_picture {
  VLAPROBE_RGB = 1,         /* U8 (height, width, 3) */
  VLAPROBE_DEPTH = 2,       /* F32 (height, width), m along the camera's axis; 0 beyond 10 m */
  VLAPROBE_SEGMENTATION = 3 /* U16 (height, width): 0 nothing, 1 + body, 65535 what has no body */
} vlaprobe_picture;
/* Of the last vlaprobe_stage_observe(). */
VLAPROBE_EXPORT int32_t vlaprobe_stage_picture(const vlaprobe_stage* stage, size_t camera,
                                               int32_t kind, vlaprobe_array* out,
                                               vlaprobe_error* error);

/* Names, for as long as the stage: NULL for an index that there is not. */
VLAPROBE_EXPORT const char* vlaprobe_stage_camera(const vlaprobe_stage* stage, size_t camera);
VLAPROBE_EXPORT const char* vlaprobe_stage_metric(const vlaprobe_stage* stage, size_t metric);
/* What a policy is told now: the task's instruction, or what it has become. */
VLAPROBE_EXPORT const char* vlaprobe_stage_instruction(const vlaprobe_stage* stage);
VLAPROBE_EXPORT int32_t vlaprobe_stage_metric_is_truth(const vlaprobe_stage* stage, size_t metric);
VLAPROBE_EXPORT const char* vlaprobe_stage_joint(const vlaprobe_stage* stage, size_t joint);
VLAPROBE_EXPORT const char* vlaprobe_stage_object(const vlaprobe_stage* stage, size_t object);
VLAPROBE_EXPORT const char* vlaprobe_stage_body(const vlaprobe_stage* stage, size_t body);
/* Height and width of a camera's pictures. */
VLAPROBE_EXPORT int32_t vlaprobe_stage_picture_size(const vlaprobe_stage* stage, size_t camera,
                                                    int32_t* height, int32_t* width,
                                                    vlaprobe_error* error);

/* The episode as it is now, as bytes, and back to it: what follows is the same bit for bit, in this
 * stage or another one of the same plan and task, also in another process. */
VLAPROBE_EXPORT int32_t vlaprobe_stage_save(vlaprobe_stage* stage, const void** bytes, size_t* size,
                                            vlaprobe_error* error);
VLAPROBE_EXPORT int32_t vlaprobe_stage_restore(vlaprobe_stage* stage, const void* bytes,
                                               size_t size, vlaprobe_error* error);

/* ---- worlds side by side */

typedef struct vlaprobe_batch vlaprobe_batch;

/* When a world's episode is over, its next one begins ... */
typedef enum vlaprobe_autoreset {
  VLAPROBE_NEXT_STEP = 0, /* in the next step, which ignores its action */
  VLAPROBE_SAME_STEP = 1, /* at once: what it ended with is in the final arrays */
  VLAPROBE_DISABLED = 2   /* when it is reset */
} vlaprobe_autoreset;

typedef struct vlaprobe_batch_options {
  uint32_t size;         /* sizeof(vlaprobe_batch_options) */
  int32_t width, height; /* of every camera's picture; 0: the camera's own */
  int32_t no_pictures;   /* 1: none are drawn, and nothing of them is set up */
  int32_t worlds;        /* 1 .. 4096 */
  int32_t threads;       /* that step them, the caller's among them; 0: one a core */
  int32_t autoreset;     /* vlaprobe_autoreset */
} vlaprobe_batch_options;

typedef struct vlaprobe_start {
  int32_t task, episode;
} vlaprobe_start;

/* `tasks` are those whose episodes the worlds may be given. They must show alike: cameras by name
 * and size, the robot's joints; and take actions of one kind and size. */
VLAPROBE_EXPORT int32_t vlaprobe_batch_create(const vlaprobe_plan* plan, const size_t* tasks,
                                              size_t count, const vlaprobe_batch_options* options,
                                              vlaprobe_batch** batch, vlaprobe_error* error);
VLAPROBE_EXPORT void vlaprobe_batch_release(vlaprobe_batch* batch);

/* Begins the episodes `starts[i]` of the worlds i whose `mask[i]` is not 0; NULL: of all. Fails
 * with the first world's failure, which names it; the others have begun. */
VLAPROBE_EXPORT int32_t vlaprobe_batch_reset(vlaprobe_batch* batch, const uint8_t* mask,
                                             const vlaprobe_start* starts, vlaprobe_error* error);
/* What the robots' actions are; the arrays are the batch's. */
VLAPROBE_EXPORT int32_t vlaprobe_batch_action_space(const vlaprobe_batch* batch,
                                                    vlaprobe_action_space* out,
                                                    vlaprobe_error* error);
/* A control step of every world; `actions` are F64 (worlds, size of the action space). A world
 * whose turn it is to begin anew begins `next[i]`; NULL with VLAPROBE_DISABLED alone. Fails with
 * VLAPROBE_USAGE, before anything moves, on an action that is none and on a world without an
 * episode. What goes wrong with one world ends its episode (truncated) and is its fault; its
 * metrics are no numbers then, and unless VLAPROBE_DISABLED its next step begins anew. */
VLAPROBE_EXPORT int32_t vlaprobe_batch_step(vlaprobe_batch* batch, const double* actions,
                                            const vlaprobe_start* next, vlaprobe_error* error);

typedef enum vlaprobe_field {
  VLAPROBE_FIELD_RGB = 1,      /* U8 (worlds, height, width, 3), of one camera */
  VLAPROBE_FIELD_TOOL = 2,     /* F64 (worlds, 7): as vlaprobe_state.tool */
  VLAPROBE_FIELD_OPENNESS = 3, /* F64 (worlds) */
  VLAPROBE_FIELD_JOINTS = 4,   /* F64 (worlds, n) */
  VLAPROBE_FIELD_METRICS =
      5, /* F64 (worlds, m): of all tasks; not a number where a world's task has none such */
  VLAPROBE_FIELD_STEPS = 6,       /* I32 (worlds): control steps of the episode */
  VLAPROBE_FIELD_TASK = 7,        /* I32 (worlds) */
  VLAPROBE_FIELD_EPISODE = 8,     /* I32 (worlds) */
  VLAPROBE_FIELD_SUCCESS = 9,     /* U8 (worlds) */
  VLAPROBE_FIELD_TERMINATED = 10, /* U8 (worlds): by the last step; behind a reset 0 */
  VLAPROBE_FIELD_TRUNCATED = 11,  /* U8 (worlds) */
  VLAPROBE_FIELD_BEGUN = 12,      /* U8 (worlds): the last step began an episode */
  VLAPROBE_FIELD_ENDED = 13,      /* U8 (worlds): it ended one that counts */
  VLAPROBE_FIELD_DECIDED = 14     /* U8 (worlds): as vlaprobe_state.decided */
} vlaprobe_field;
/* What is now: behind the last reset or step. `camera` is read for pictures alone. */
VLAPROBE_EXPORT int32_t vlaprobe_batch_array(const vlaprobe_batch* batch, int32_t field,
                                             size_t camera, vlaprobe_array* out,
                                             vlaprobe_error* error);
/* What the episodes that the last step ended (VLAPROBE_SAME_STEP) ended with; of other worlds
 * nothing is said. */
VLAPROBE_EXPORT int32_t vlaprobe_batch_final(const vlaprobe_batch* batch, int32_t field,
                                             size_t camera, vlaprobe_array* out,
                                             vlaprobe_error* error);
/* What went wrong with a world in the last step; NULL: nothing. */
VLAPROBE_EXPORT const char* vlaprobe_batch_fault(const vlaprobe_batch* batch, size_t world);
/* Names, for as long as the batch: NULL for an index that there is not. */
VLAPROBE_EXPORT const char* vlaprobe_batch_camera(const vlaprobe_batch* batch, size_t camera);
VLAPROBE_EXPORT const char* vlaprobe_batch_metric(const vlaprobe_batch* batch, size_t metric);
VLAPROBE_EXPORT int32_t vlaprobe_batch_metric_is_truth(const vlaprobe_batch* batch, size_t metric);
/* What a policy is told now; NULL before a world's first episode. */
VLAPROBE_EXPORT const char* vlaprobe_batch_instruction(const vlaprobe_batch* batch, size_t world);
/* As vlaprobe_stage_hash(). */
VLAPROBE_EXPORT int32_t vlaprobe_batch_hash(const vlaprobe_batch* batch, size_t world,
                                            char hash[65], vlaprobe_error* error);

/* ---- policies of ours */

typedef struct vlaprobe_policy vlaprobe_policy;

/* As after `--policy`: "expert", "noisy:0.01", "openpi://HOST:PORT?profile=NAME". */
VLAPROBE_EXPORT int32_t vlaprobe_policy_create(const char* text, vlaprobe_policy** policy,
                                               vlaprobe_error* error);
VLAPROBE_EXPORT void vlaprobe_policy_release(vlaprobe_policy* policy);
/* Behind each reset and restore of the stage, before the first act; `seed` is what its draws start
 * from, with the episode. */
VLAPROBE_EXPORT int32_t vlaprobe_policy_begin(vlaprobe_policy* policy, const vlaprobe_stage* stage,
                                              int32_t seed, vlaprobe_error* error);
/* What the policy does about what the stage shows now; draws pictures. VLAPROBE_USAGE where
 * `size` is not that of the stage's action space, and where the stage was reset or restored since
 * the policy began: what it keeps is of another episode. */
VLAPROBE_EXPORT int32_t vlaprobe_policy_act(vlaprobe_policy* policy, vlaprobe_stage* stage,
                                            double* action, size_t size, vlaprobe_error* error);

/* ---- runs: episodes into a folder, as `vlaprobe run` makes them */

/* What a policy of the caller's is asked. Of no meaning behind the callback's end. */
typedef struct vlaprobe_camera_picture {
  const char* camera;
  vlaprobe_array rgb; /* U8 (height, width, 3) */
} vlaprobe_camera_picture;
typedef struct vlaprobe_question {
  int32_t world; /* which of the worlds asks, from 0: one whose `step` is 0 begins an episode */
  int32_t episode, seed, step, horizon;
  uint64_t draw_seed; /* of this episode and seed: what a policy that draws starts from */
  const char* task;
  const char* instruction;
  double tool[7]; /* as vlaprobe_state */
  double openness;
  vlaprobe_array joints;
  size_t action_size; /* numbers of its answer; one for all questions of a call */
  const vlaprobe_camera_picture*
      pictures; /* of the first camera first; all questions of a call have alike ones */
  size_t picture_count;
} vlaprobe_question;

/* Where a callback says that a question has no answer: the first text of each question counts. */
typedef struct vlaprobe_refusals vlaprobe_refusals;
VLAPROBE_EXPORT void vlaprobe_refuse(vlaprobe_refusals* refusals, size_t question, const char* why);

/* Answers `count` questions with their `action_size` numbers each, one behind the other; or
 * refuses some, whose episodes are invalid then, with the reason. Called from threads of the
 * library, one call at a time. */
typedef void (*vlaprobe_act_callback)(void* user, const vlaprobe_question* questions, size_t count,
                                      double* actions, vlaprobe_refusals* refusals);

typedef struct vlaprobe_progress {
  int32_t done, skipped, total; /* episodes: of this call, found in the folder, chosen */
  const char* task;             /* of the one just stored; NULL in the first report */
  int32_t episode, seed, steps;
  int32_t success;     /* 0 where there is no such metric, or the episode is invalid */
  const char* invalid; /* why; NULL: valid */
} vlaprobe_progress;
/* One call at a time. Not 0: no further episode begins, and vlaprobe_run() returns
 * VLAPROBE_STOPPED. */
typedef int32_t (*vlaprobe_progress_callback)(void* user, const vlaprobe_progress* progress);

typedef enum vlaprobe_if_changed {
  VLAPROBE_REFUSE = 0,
  VLAPROBE_FORK = 1,
  VLAPROBE_CONTINUE = 2
} vlaprobe_if_changed;
typedef enum vlaprobe_videos {
  VLAPROBE_NO_VIDEOS = 0,
  VLAPROBE_FAILURES = 1,
  VLAPROBE_ALL_VIDEOS = 2
} vlaprobe_videos;

/* NULL and 0 are the defaults; the options of `vlaprobe run` say more of those of their names. */
typedef struct vlaprobe_run_options {
  uint32_t size;      /* sizeof(vlaprobe_run_options) */
  const char* out;    /* the folder; made if absent, continued if there */
  const char* policy; /* as after --policy; of none where `act` answers */
  const char* name;   /* what folder and rows call the policy; needed with `act` */
  /* With `act`: what the name does not say, such as the hash of its weights. Without it a call that
   * continues a folder asks for a stored episode again first, and fails with VLAPROBE_STORE where
   * an action is not the stored one. */
  const char* content;
  const char* suite;    /* default: the first */
  const char* tasks;    /* glob; default: all */
  int32_t originals;    /* 1: of these only tasks that are no variant */
  int32_t has_episodes; /* 1: only those from first_episode to last_episode */
  int32_t first_episode, last_episode;
  const int32_t* seeds; /* default: the suite's */
  size_t seed_count;
  int32_t jobs;       /* worlds at a time, a thread each; default 1 */
  int32_t if_changed; /* vlaprobe_if_changed */
  int32_t videos;     /* vlaprobe_videos */
  vlaprobe_act_callback act;
  int32_t draws; /* with `act`: two seeds may give two episodes; else only the first seed is run */
  int32_t batch; /* most questions in a call; default: as many as worlds */
  double gather_s; /* how long a question waits for those of other worlds; default 0.1 */
  vlaprobe_progress_callback progress;
  void* user; /* given to the callbacks */
  /* Asked now and then, from any thread: not 0 ends the run as `progress` does, and refuses the
   * questions that wait. */
  int32_t (*stopped)(void* user);
  const char* until; /* as behind --until; default: every chosen episode is run */
} vlaprobe_run_options;

/* `summary` is JSON: {"out", "total", "done", "skipped", "invalid", "not_attempted",
 * "not_attempted_reasons": [{"reason", "episodes"}], the most frequent first, "notes": [sentences],
 * "until": [sentences of what is known of a run that stops early], "speed"}; it may be NULL.
 * Episodes that fail are rows that are invalid, not failures of the run.
 */
VLAPROBE_EXPORT int32_t vlaprobe_run(const vlaprobe_plan* plan, const vlaprobe_run_options* options,
                                     char** summary, vlaprobe_error* error);

/* ---- asking: a plan's questions to a model that sees and reads, as `vlaprobe ask` puts them */

/* What a model of the caller's is asked. Of no meaning behind the callback's end. */
typedef struct vlaprobe_asked {
  const char* text;     /* all words that are sent, options and how to answer among them */
  vlaprobe_array rgb;   /* U8 (height, width, 3): the picture; data NULL where none is shown */
  vlaprobe_array png;   /* U8 (bytes): the same as a file */
  const char* question; /* "SET.FAMILY" */
  const char* task;
  const char* arm; /* "picture", "blind", "prior" */
  int32_t episode, rotation;
} vlaprobe_asked;

/* Where a callback writes: the last call counts; without one the question has no answer. */
typedef struct vlaprobe_reply vlaprobe_reply;
VLAPROBE_EXPORT void vlaprobe_reply_say(vlaprobe_reply* reply, const char* words);
/* No answer: the row is invalid, with the reason, and asked again by the next call. */
VLAPROBE_EXPORT void vlaprobe_reply_refuse(vlaprobe_reply* reply, const char* why);

/* Called from threads of the library, from as many at a time as there are jobs. */
typedef void (*vlaprobe_answer_callback)(void* user, const vlaprobe_asked* asked,
                                         vlaprobe_reply* reply);

typedef struct vlaprobe_ask_progress {
  int64_t done, skipped, total; /* answered by this call; found, or left out; chosen */
  const char* question; /* "SET.FAMILY" of the one just answered; NULL in the first report */
  const char* task;
  const char* raw; /* what was said */
  int32_t episode;
  int32_t right;       /* 0 where the answer is invalid */
  const char* invalid; /* why; NULL: valid */
} vlaprobe_ask_progress;
/* One call at a time. Not 0 ends the call: vlaprobe_ask() returns VLAPROBE_STOPPED. */
typedef int32_t (*vlaprobe_ask_progress_callback)(void* user,
                                                  const vlaprobe_ask_progress* progress);

/* NULL and 0 are the defaults; the options of `vlaprobe ask` say more of those of their names. */
typedef struct vlaprobe_ask_options {
  uint32_t size;         /* sizeof(vlaprobe_ask_options) */
  const char* out;       /* the folder; made if absent, continued if there */
  const char* model;     /* as after --model; of none where `answer` answers */
  const char* name;      /* what folder and rows call the model; needed with `answer` */
  const char* content;   /* with `answer`: what the name does not say */
  const char* suite;     /* default: the first that is asked something */
  const char* tasks;     /* glob; default: all */
  const char* questions; /* SET or SET.FAMILY, with * and ?, commas between; default: all */
  const char* arms;      /* of picture, blind, prior, commas between; default: picture */
  const char* frames;    /* folder of a run: its ends are what questions at the end are about */
  int32_t has_episodes;  /* 1: only those from first_episode to last_episode */
  int32_t first_episode, last_episode;
  int32_t shard, shards;       /* this call's share of shards; default: 1 of 1 */
  int32_t jobs;                /* questions at the model at a time, a thread each; default 1 */
  int32_t has_retries;         /* 1: `retries` counts; else 2 */
  int32_t retries;             /* of a question that a server failed, at once */
  int32_t has_give_up_after;   /* 1: `give_up_after` counts; else 5 */
  int32_t give_up_after;       /* questions in a row that a server failed; 0: never */
  int32_t accepts_certificate; /* 1: any certificate of an https:// server; stored and told */
  int32_t if_changed;          /* vlaprobe_if_changed */
  int32_t width, height;       /* with `answer`: of its pictures; 0: the camera's own */
  const char* camera;          /* with `answer`: which one's; default: the task's first */
  vlaprobe_answer_callback answer;
  vlaprobe_ask_progress_callback progress;
  void* user; /* given to the callbacks */
  /* Asked now and then, from a thread of the library: not 0 ends the call when the questions that
   * are at the model are answered. */
  int32_t (*stopped)(void* user);
} vlaprobe_ask_options;

/* `summary` is JSON: {"out", "total", "done", "skipped", "invalid", "right", "left_out", "notes":
 * [sentences], "speed"}; it may be NULL. Answers that fail are rows that are invalid; a server that
 * fails again and again is VLAPROBE_POLICY. */
VLAPROBE_EXPORT int32_t vlaprobe_ask(const vlaprobe_plan* plan, const vlaprobe_ask_options* options,
                                     char** summary, vlaprobe_error* error);

/* A JSON object of a folder of answers: "model", "plan_root", "suite", "frames", "notes":
 * [sentences], "scores": [an object a question and arm], "left_out": [{"question", "why",
 * "count"}], "rows" as `vlaprobe results DIR --json` has them. Every row is read again from its
 * words. */
VLAPROBE_EXPORT int32_t vlaprobe_answers(const char* folder, char** json, vlaprobe_error* error);
/* As `vlaprobe why ANSWERS ... --json`. `seed` of -1: all; `question` NULL: all. */
VLAPROBE_EXPORT int32_t vlaprobe_why_answers(const char* folder, const char* task, int32_t episode,
                                             int32_t seed, const char* question, char** json,
                                             vlaprobe_error* error);

/* ---- what runs found */

/* A JSON object: "rows" as `vlaprobe results DIR --json` has them, "refused": sentences, one an
 * episode whose trace does not bear its row, and "policy", "plan_root", "suite". */
VLAPROBE_EXPORT int32_t vlaprobe_results(const char* folder, char** json, vlaprobe_error* error);
/* As `vlaprobe why ... --json`. `seed` of -1: the lowest stored; `metric` NULL: all. */
VLAPROBE_EXPORT int32_t vlaprobe_why(const char* folder, const char* task, int32_t episode,
                                     int32_t seed, const char* metric, char** json,
                                     vlaprobe_error* error);

/* As `vlaprobe compare A B --json`, with "text" and "notes" beside it: {"comparison", "text",
 * "notes": [sentences]}. */
VLAPROBE_EXPORT int32_t vlaprobe_compare(const char* folder, const char* other,
                                         const char* const* metrics, size_t metric_count,
                                         char** json, vlaprobe_error* error);

typedef struct vlaprobe_report_options {
  uint32_t size;   /* sizeof(vlaprobe_report_options) */
  const char* out; /* the page that is written; needed */
  const char* title;
  const char* floors; /* CSV of floors and ceilings measured before, as suite/floors.csv */
  int32_t no_traces;  /* 1: no timelines and no explained verdicts */
  int32_t jobs;       /* threads that read traces; default: one a core */
} vlaprobe_report_options;
/* One page of these folders, as `vlaprobe report`. JSON: {"out", "policies", "episodes", "notes":
 * [sentences]}. */
VLAPROBE_EXPORT int32_t vlaprobe_report(const char* const* folders, size_t count,
                                        const vlaprobe_report_options* options, char** json,
                                        vlaprobe_error* error);

typedef struct vlaprobe_replay_options {
  uint32_t size;      /* sizeof(vlaprobe_replay_options) */
  const char* assets; /* as of plans */
  const char* video;  /* an mp4 to write; NULL: none */
  const char* png;    /* the picture at `png_step` to write; NULL: none */
  int32_t png_step;
  const char* camera; /* the one that is shown; NULL: all, side by side */
  int32_t no_verify;  /* 1: what follows is not compared with the trace */
} vlaprobe_replay_options;
/* The stored episode again, from its actions, in a fresh world. JSON: {"steps", "seed",
 * "identical", "difference", "fingerprint_differences"}; `identical` is null where nothing was
 * compared. */
VLAPROBE_EXPORT int32_t vlaprobe_replay(const char* folder, const char* task, int32_t episode,
                                        int32_t seed, const vlaprobe_replay_options* options,
                                        char** json, vlaprobe_error* error);

#ifdef __cplusplus
}
#endif

#endif
