// A plan's questions to a model, and what is told of the answers.
#include "runtime/ask/ask.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "runtime/api/arrays.h"
#include "runtime/api/calls.h"
#include "runtime/api/folders.h"
#include "runtime/api/plan.h"
#include "runtime/api/world.h"
#include "runtime/ask/answer_fields.h"
#include "runtime/ask/answers.h"
#include "runtime/ask/score_json.h"
#include "runtime/ask/vouch.h"
#include "runtime/ask/why_answer.h"
#include "runtime/base/clock.h"
#include "runtime/base/json.h"
#include "runtime/plan/family_name.h"
#include "runtime/scene/image.h"

struct vlaprobe_reply {
  std::optional<std::string> words, refusal;
};

using namespace probe;
using api::call;
using api::text_of;

namespace {

// The parts of "a,b"; none of NULL and "".
std::vector<std::string> parts_of(const char* list) {
  std::vector<std::string> parts;
  std::string rest = text_of(list);
  while (!rest.empty()) {
    const std::size_t comma = rest.find(',');
    parts.push_back(rest.substr(0, comma));
    rest = comma == std::string::npos ? "" : rest.substr(comma + 1);
  }
  return parts;
}

Result<std::vector<ask::Arm>> arms_of(const char* list) {
  std::vector<ask::Arm> arms;
  for (const std::string& word : parts_of(list)) {
    PROBE_ASSIGN(const ask::Arm arm, ask::arm_of(word));
    if (std::ranges::find(arms, arm) == arms.end()) arms.push_back(arm);
  }
  std::ranges::sort(arms);
  if (arms.empty()) arms.push_back(ask::Arm::kPicture);
  return arms;
}

Result<ask::QueryChoice> read_choice(const vlaprobe_ask_options& given,
                                     const api::SharedPlan& plan) {
  ask::QueryChoice choice;
  choice.suite = text_of(given.suite);
  choice.whole_plan = plan.only_used_suites && choice.suite.empty();
  if (given.tasks != nullptr) choice.tasks = given.tasks;
  choice.questions = parts_of(given.questions);
  PROBE_ASSIGN(choice.arms, arms_of(given.arms));
  if (given.has_episodes != 0) {
    PROBE_ASSIGN(choice.episodes, api::read_episodes(given.first_episode, given.last_episode));
  }
  if (given.shard != 0 || given.shards != 0) {
    if (given.shard < 1 || given.shard > given.shards) {
      return api::usage("a shard is one from 1 to their number, found " +
                        std::to_string(given.shard) + " of " + std::to_string(given.shards));
    }
    choice.shard = given.shard;
    choice.shards = given.shards;
  }
  return choice;
}

Result<ask::AskOptions> read(const vlaprobe_ask_options& given, const api::SharedPlan& plan) {
  ask::AskOptions options;
  options.out = text_of(given.out);
  options.model = text_of(given.model);
  options.name = text_of(given.name);
  options.frames = text_of(given.frames);
  options.assets = plan.asset_root();
  if (options.out.empty()) return api::usage("answers have a folder to be written to: `out`");
  PROBE_ASSIGN(options.choice, read_choice(given, plan));
  PROBE_ASSIGN(options.jobs, api::read_jobs(given.jobs, "questions"));
  PROBE_ASSIGN(options.if_changed, api::read_if_changed(given.if_changed));
  if (given.has_retries != 0) options.retries = given.retries;
  if (given.has_give_up_after != 0) options.give_up_after = given.give_up_after;
  if (options.retries < 0 || options.give_up_after < 0)
    return api::usage("`retries` and `give_up_after` are 0 or more");
  options.accepts_any_certificate = given.accepts_certificate != 0;
  return options;
}

// A model of the caller's, one of each asking thread.
class Answering final : public ask::Model {
 public:
  Answering(vlaprobe_answer_callback callback, void* user) : callback_(callback), user_(user) {}

  Result<ask::Said> answer(const ask::AskedQuery& asked) override {
    const plan::Plan& plan = asked.plan;
    const std::string question = plan::family_name(plan, plan.families()[asked.question.family]);
    const std::string task(plan.text(plan.tasks()[asked.question.task].name));
    const std::string arm(ask::word_of(asked.arm));
    vlaprobe_asked told{};
    std::vector<std::uint8_t> rgb;
    if (asked.picture != nullptr) {
      PROBE_ASSIGN(rgb, pixels_of(asked.picture->png));
      told.rgb = api::array_of(std::span<const std::uint8_t>(rgb),
                               {static_cast<std::size_t>(asked.picture->height),
                                static_cast<std::size_t>(asked.picture->width), 3});
      const auto* bytes = reinterpret_cast<const std::uint8_t*>(asked.picture->png.data());
      told.png =
          api::array_of(std::span(bytes, asked.picture->png.size()), {asked.picture->png.size()});
    }
    told.text = asked.wording.text.c_str();
    told.question = question.c_str();
    told.task = task.c_str();
    told.arm = arm.c_str();
    told.episode = asked.episode;
    told.rotation = static_cast<std::int32_t>(asked.rotation);
    vlaprobe_reply reply;
    const auto begun = std::chrono::steady_clock::now();
    callback_(user_, &told, &reply);
    if (reply.refusal) return Failure{Fault::kPolicy, *reply.refusal, ""};
    if (!reply.words) return Failure{Fault::kPolicy, "the callback said nothing", ""};
    return ask::Said{.raw = std::move(*reply.words), .latency_s = seconds_since(begun)};
  }

 private:
  // Of the very file that the row has the hash of.
  static Result<std::vector<std::uint8_t>> pixels_of(const std::string& png) {
    PROBE_ASSIGN(const scene::Texture texture,
                 scene::decode_image(std::as_bytes(std::span(png)), "the picture that is sent"));
    std::vector<std::uint8_t> rgb;
    rgb.reserve(texture.rgba.size() / 4 * 3);
    for (std::size_t i = 0; i < texture.rgba.size(); ++i) {
      if (i % 4 != 3) rgb.push_back(texture.rgba[i]);
    }
    return rgb;
  }

  vlaprobe_answer_callback callback_;
  void* user_;
};

Status use_callback(const vlaprobe_ask_options& given, ask::AskOptions& options) {
  if (!options.model.empty())
    return api::usage("either `model` or `answer` answers: both were given");
  if (options.name.empty()) return api::usage("a model of the caller's has a `name`");
  PROBE_TRY(api::check_picture_size(given.width, given.height));
  options.model = options.name;
  // What fails in a callback would only fail again; it is stored with its reason.
  options.give_up_after = 0;
  ask::ModelTraits traits;
  traits.name = options.name;
  traits.arms = {ask::Arm::kPicture, ask::Arm::kBlind, ask::Arm::kPrior};
  traits.picture.camera = text_of(given.camera);
  traits.picture.width = given.width;
  traits.picture.height = given.height;
  traits.is_shown = true;
  // How it is asked, as of a server, and what the name does not say.
  traits.content = "the caller's";
  if (!traits.picture.camera.empty()) traits.content += ", camera " + traits.picture.camera;
  if (given.width != 0)
    traits.content += ", size " + std::to_string(given.width) + "x" + std::to_string(given.height);
  if (const std::string said = text_of(given.content); !said.empty()) traits.content += ": " + said;
  options.own_model = ask::OwnModel{
      traits,
      [callback = given.answer, user = given.user]() -> Result<std::unique_ptr<ask::Model>> {
        return std::unique_ptr<ask::Model>(std::make_unique<Answering>(callback, user));
      },
      given.content != nullptr&&* given.content != '\0'};
  return {};
}

void tell(const ask::AskProgress& progress, const vlaprobe_ask_options& given,
          std::atomic<bool>& stop) {
  vlaprobe_ask_progress told{};
  told.done = progress.done;
  told.skipped = progress.skipped;
  told.total = progress.total;
  std::string question;
  if (const ask::AnswerRow* row = progress.row) {
    question = plan::family_name(row->set, row->family);
    told.question = question.c_str();
    told.task = row->task.c_str();
    told.raw = row->raw.c_str();
    told.episode = row->episode;
    told.right = !row->invalid && row->right.value_or(false) ? 1 : 0;
    told.invalid = row->invalid ? row->invalid->c_str() : nullptr;
  }
  if (given.progress(given.user, &told) != 0) stop = true;
}

// What a reader of the answers should know.
Result<std::vector<std::string>> notes_of(const std::string& folder, const ask::RowFindings& rows) {
  std::vector<std::string> notes = rows.sentences();
  PROBE_ASSIGN(const std::vector<ask::AskCall> calls, ask::read_ask_calls(folder));
  if (const std::string missing = ask::missing_shards(calls); !missing.empty())
    notes.push_back(folder + " " + missing);
  for (const ask::AskCall& call : calls) {
    for (std::string& finding : ask::findings_of(call.proof)) {
      if (std::ranges::find(notes, finding) == notes.end()) notes.push_back(std::move(finding));
    }
  }
  return notes;
}

}  // namespace

extern "C" {

void vlaprobe_reply_say(vlaprobe_reply* reply, const char* words) {
  if (reply == nullptr) return;
  call(nullptr, [&]() -> Status {
    reply->refusal.reset();
    reply->words = text_of(words);
    return {};
  });
}

void vlaprobe_reply_refuse(vlaprobe_reply* reply, const char* why) {
  if (reply == nullptr) return;
  call(nullptr, [&]() -> Status {
    reply->words.reset();
    reply->refusal = why == nullptr ? "no reason was given" : why;
    return {};
  });
}

int32_t vlaprobe_ask(const vlaprobe_plan* plan, const vlaprobe_ask_options* options, char** summary,
                     vlaprobe_error* error) {
  std::atomic<bool> stop = false;
  const int32_t code = call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{plan, "plan"}, {options, "options"}}));
    PROBE_ASSIGN(const vlaprobe_ask_options given, api::read_options(options));
    PROBE_ASSIGN(ask::AskOptions wanted, read(given, *plan->shared));
    wanted.stopped = [&] {
      if (given.stopped != nullptr && given.stopped(given.user) != 0) stop = true;
      return stop.load();
    };
    if (given.answer != nullptr) PROBE_TRY(use_callback(given, wanted));
    if (given.progress != nullptr)
      wanted.progress = [&](const ask::AskProgress& progress) { tell(progress, given, stop); };
    PROBE_ASSIGN(const ask::AskSummary made, ask::ask(plan->shared->plan(), wanted));
    return api::give({{"out", made.out.empty() ? wanted.out : made.out},
                      {"total", made.total},
                      {"done", made.done},
                      {"skipped", made.skipped},
                      {"invalid", made.invalid},
                      {"right", made.right},
                      {"left_out", made.left_out},
                      {"notes", made.notes},
                      {"speed", made.done > 0 ? ask::to_text(made.call) : ""}},
                     summary);
  });
  if (code == VLAPROBE_OK || !stop) return code;
  return api::fail(error, VLAPROBE_STOPPED, "the call was stopped; the same one continues", {});
}

int32_t vlaprobe_answers(const char* folder, char** json, vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{folder, "folder"}, {json, "json"}}));
    PROBE_ASSIGN(const ask::AskRecord record, ask::read_ask_record(folder));
    PROBE_ASSIGN(const plan::Plan plan, ask::open_asked_plan(folder));
    ask::Tally tally(plan);
    ask::RowFindings findings;
    // Rows are text at once, and can be more than a tree of ours holds.
    std::string rows;
    PROBE_TRY(ask::for_each_answer(folder, [&](const ask::AnswerRow& row, std::uint32_t) {
      findings.add(row);
      rows += (rows.empty() ? "" : ",") + ask::to_json(row).dump();
      return tally.add(row);
    }));
    Json scores = Json::array();
    for (const ask::ScoreRow& row : ask::score(plan, tally.asked())) {
      for (const Json& arm : ask::arms_json(plan, row)) scores.push_back(arm);
    }
    std::map<std::pair<std::string, std::string>, std::int64_t> left_out;
    PROBE_TRY(ask::for_each_left_out(folder, [&](const ask::LeftOut& out, std::uint32_t) -> Status {
      ++left_out[{plan::family_name(out.set, out.family), out.why}];
      return {};
    }));
    Json out = Json::array();
    for (const auto& [what, count] : left_out)
      out.push_back({{"question", what.first}, {"why", what.second}, {"count", count}});
    PROBE_ASSIGN(const std::vector<std::string> notes, notes_of(folder, findings));
    std::string text = Json{
        {"model", record.identity.model},
        {"plan_root", record.identity.plan_root},
        {"suite", record.suite},
        {"frames", record.identity.frames},
        {"notes", notes},
        {"scores", std::move(scores)},
        {"left_out",
         std::move(out)}}.dump();
    text.back() = ',';
    text += "\"rows\":[" + rows + "]}";
    return api::give_text(text, json);
  });
}

int32_t vlaprobe_why_answers(const char* folder, const char* task, int32_t episode, int32_t seed,
                             const char* question, char** json, vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{folder, "folder"}, {task, "task"}, {json, "json"}}));
    const std::optional<int> asked = seed < 0 ? std::nullopt : std::optional<int>(seed);
    PROBE_ASSIGN(const ask::StartWhy why,
                 ask::why_answers(folder, task, episode, asked, text_of(question)));
    return api::give(ask::to_json(why), json);
  });
}
}
