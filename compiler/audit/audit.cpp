#include "compiler/audit/audit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <set>

#include "compiler/audit/questions.h"
#include "compiler/audit/rules.h"
#include "compiler/audit/stage.h"
#include "compiler/audit/warning_scope.h"
#include "runtime/base/utf8.h"
#include "runtime/base/words.h"
#include "runtime/plan/axes.h"
#include "runtime/plan/later.h"
#include "runtime/plan/skills.h"
#include "runtime/vm/derived_solution.h"

namespace probe::audit {
namespace {

// A solution that puts something beside something: there is where it shall lie.
bool goes_beside(const plan::Plan& plan, std::uint32_t task) {
  return std::ranges::any_of(
      plan::skills_of(plan.tables(), task), [](const plan::SkillRecord& skill) {
        return skill.relation == static_cast<std::uint32_t>(plan::SkillRelation::kBeside);
      });
}

struct KindName {
  Kind kind;
  std::string_view name, title;
};
constexpr std::array<KindName, 28> kKinds = {{
    {Kind::kConfounded, "confounded", "comparisons that move more than one axis"},
    {Kind::kAcrossScenes, "across_scenes", "comparisons across scenes"},
    {Kind::kAcrossLayouts, "across_layouts", "comparisons across layouts"},
    {Kind::kHorizon, "horizon", "comparisons of episodes of another length"},
    {Kind::kSuccessRule, "success_rule", "compared tasks whose success is another rule"},
    {Kind::kUnlisted, "unlisted", "comparisons that no suite holds"},
    {Kind::kDuplicate, "duplicate", "tasks that are the same to policy and judge"},
    {Kind::kSamePrompt, "same_prompt", "other words meant, the same words said"},
    {Kind::kNamesake, "namesake", "two objects of one name"},
    {Kind::kWrongCountsTarget, "wrong_counts_target", "wrong-object metrics that count the target"},
    {Kind::kWrongAtEnd, "wrong_at_end",
     "wrong-object metrics read at the last step, beside metrics that latch"},
    {Kind::kEndsInGrasp, "ends_in_grasp",
     "success that needs the gripper to hold at the last step"},
    {Kind::kBeside, "beside", "success of an object that lies on the table beside the target"},
    {Kind::kOnFixture, "on_fixture",
     "success of an object that lies on a fixture beside the target"},
    {Kind::kHeld, "held", "success of an object that is still held above the target or in it"},
    {Kind::kInTheAir, "in_the_air", "success of an object in the air that nothing touches"},
    {Kind::kTouchedOnce, "touched_once",
     "success at the last step that counts a touch which may be over"},
    {Kind::kHoldsAtStart, "holds_at_start", "success that holds before anything moves"},
    {Kind::kSwappedOrder, "swapped_order",
     "success that does not care for the order that the instruction says"},
    {Kind::kSolution, "solution", "solutions that do not do what success asks for"},
    {Kind::kFallsOn, "falls_on", "starts in which objects fall onto one another"},
    {Kind::kUnfelt, "unfelt", "parts of fixtures that are seen where nothing is felt"},
    {Kind::kNamesAnswer, "names_answer", "questions whose words name the answer"},
    {Kind::kOneAnswer, "one_answer", "questions with one answer throughout"},
    {Kind::kOneLetter, "one_letter", "questions whose right option stands at one place"},
    {Kind::kCoin, "coin", "questions with two options"},
    {Kind::kTable, "table", "published percentages that the suite cannot give"},
    {Kind::kWarning, "warning", "warnings, said or silenced"},
}};

class Auditor {
 public:
  Auditor(const Compilation& compilation, const plan::Plan& plan, std::uint32_t suite,
          std::span<const std::string> files)
      : compilation_(compilation), plan_(plan), suite_(plan.suites()[suite]) {
    for (const std::string& file : files)
      roots_.insert(std::filesystem::path(file).lexically_normal().generic_string());
    const auto members = plan.members(suite_);
    scope_.assign(members.begin(), members.end());
  }

  Result<Audit> run() {
    audit_.suite = std::string(plan_.text(suite_.name));
    audit_.tasks = scope_.size();
    for (const std::uint32_t task : scope_)
      audit_.comparisons += plan_.tasks()[task].baseline != plan::kNone ? 1 : 0;
    find_unlisted();
    for (const std::uint32_t task : scope_) compare(task);
    find_duplicates();
    find_namesakes();
    PROBE_TRY(find_rules());
    find_falls();
    find_unfelt();
    find_questions();
    find_warnings();
    find_unheld();
    audit_.robots = robots_of(plan_, scope_);
    std::stable_sort(audit_.findings.begin(), audit_.findings.end(),
                     [](const Finding& a, const Finding& b) { return a.kind < b.kind; });
    return std::move(audit_);
  }

 private:
  std::string name_of(std::uint32_t task) const {
    return std::string(plan_.text(plan_.tasks()[task].name));
  }

  // A place of the plan as the compiler's messages name it.
  Place place(const plan::SpanRecord* span) const {
    if (span == nullptr) return {};
    const std::string_view path = plan_.tables().path(plan_.texts()[span->text]);
    for (std::uint32_t i = 0; i < compilation_.sources.size(); ++i) {
      const SourceFile& file = compilation_.sources.file(FileId{i});
      if (file.text() != plan_.tables().source(plan_.texts()[span->text])) continue;
      const LineColumn at = file.line_column(span->begin);
      return {file.name(), at.line, at.column};
    }
    return {std::string(path), 0, 0};
  }
  Place place(const Span& span) const {
    if (span.is_none()) return {};
    const SourceFile& file = compilation_.sources.file(span.file);
    const LineColumn at = file.line_column(span.begin);
    return {file.name(), at.line, at.column};
  }
  Place task_place(std::uint32_t task) const {
    return place(plan_.span_of(plan::SpanKind::kTasks, task));
  }

  void add(Finding finding) { audit_.findings.push_back(std::move(finding)); }

  Finding comparison(Kind kind, std::uint32_t task, std::string message) const {
    const plan::TaskRecord& record = plan_.tasks()[task];
    Finding finding;
    finding.kind = kind;
    finding.tasks = {name_of(task)};
    finding.baseline = name_of(record.baseline);
    for (const std::string_view name : plan::axis_names(record.axes))
      finding.axes.emplace_back(name);
    finding.message = std::move(message);
    finding.place = task_place(task);
    if (record.allow.length != 0) finding.allowed = std::string(plan_.text(record.allow));
    return finding;
  }

  // Declared in a named file and compared, and in no suite at all: from now on in the scope.
  void find_unlisted() {
    std::set<std::uint32_t> listed;
    for (const plan::SuiteRecord& suite : plan_.suites()) {
      for (const std::uint32_t task : plan_.members(suite)) listed.insert(task);
    }
    for (std::uint32_t task = 0; task < plan_.tasks().size(); ++task) {
      const std::uint32_t baseline = plan_.tasks()[task].baseline;
      if (baseline == plan::kNone || listed.contains(task)) continue;
      const Place at = task_place(task);
      if (!roots_.contains(std::filesystem::path(at.file).lexically_normal().generic_string()))
        continue;
      Finding finding = comparison(Kind::kUnlisted, task,
                                   fmt::format("`{}` is compared with `{}` and is in no suite",
                                               name_of(task), name_of(baseline)));
      finding.allowed.reset();
      add(std::move(finding));
      scope_.push_back(task);
    }
  }

  // Where a rule of the task is written.
  const plan::SpanRecord* rule(const plan::TaskRecord& task, std::string_view metric) const {
    const auto index = plan_.find_metric(task, metric);
    if (!index) return nullptr;
    return plan_.span_of(plan::SpanKind::kMetrics,
                         plan_.programs()[task.program].metrics.first + *index);
  }

  void compare(std::uint32_t index) {
    const plan::TaskRecord& task = plan_.tasks()[index];
    if (task.baseline == plan::kNone) return;
    const plan::TaskRecord& baseline = plan_.tasks()[task.baseline];
    const std::string pair =
        fmt::format("`{}` against `{}`", name_of(index), name_of(task.baseline));
    check_words(index, pair);
    Finding all = comparison(Kind::kConfounded, index, "");
    if (all.axes.size() < 2) return;
    all.message = fmt::format("{} moves {}", pair, fmt::join(all.axes, ", "));
    add(std::move(all));
    if (moves(task.axes, plan::Axis::kScene)) {
      add(comparison(Kind::kAcrossScenes, index,
                     fmt::format("{}: scene `{}` against `{}`", pair,
                                 plan_.text(plan_.scenes()[task.scene].name),
                                 plan_.text(plan_.scenes()[baseline.scene].name))));
    }
    if (moves(task.axes, plan::Axis::kLayout))
      add(comparison(Kind::kAcrossLayouts, index, pair + ": the starts are other"));
    if (task.horizon != baseline.horizon) {
      add(comparison(Kind::kHorizon, index,
                     fmt::format("{}: {} steps against {}", pair, task.horizon, baseline.horizon)));
    }
    const plan::SpanRecord* here = rule(task, "success");
    const plan::SpanRecord* there = rule(baseline, "success");
    if (here == nullptr || there == nullptr) return;
    if (here->text == there->text && here->begin == there->begin) return;
    const Place of_task = place(here), of_baseline = place(there);
    add(comparison(Kind::kSuccessRule, index,
                   fmt::format("{}: success of {}:{} against that of {}:{}", pair, of_task.file,
                               of_task.line, of_baseline.file, of_baseline.line)));
  }

  // A comparison of words whose words are the same.
  void check_words(std::uint32_t index, const std::string& pair) {
    const plan::TaskRecord& task = plan_.tasks()[index];
    if ((task.axes & plan::kLanguageAxes) == 0) return;
    const std::string_view prompt = plan_.text(task.prompt);
    if (plan::whole_instruction(plan_.tables(), index) !=
        plan::whole_instruction(plan_.tables(), task.baseline))
      return;
    add(comparison(Kind::kSamePrompt, index, fmt::format("{}: both say \"{}\"", pair, prompt)));
  }

  // Equal episodes are equal starts, words and judges.
  void find_duplicates() {
    std::map<std::vector<std::array<std::uint8_t, 32>>, std::uint32_t> known;
    for (const std::uint32_t task : scope_) {
      std::vector<std::array<std::uint8_t, 32>> ids;
      for (const plan::EpisodeRecord& episode : plan_.episodes(plan_.tasks()[task]))
        ids.push_back(episode.episode_id);
      const auto [at, is_new] = known.try_emplace(std::move(ids), task);
      if (is_new) continue;
      Finding finding;
      finding.kind = Kind::kDuplicate;
      finding.tasks = {name_of(at->second), name_of(task)};
      finding.message = fmt::format("`{}` has the starts, the words and the judge of `{}`",
                                    name_of(task), name_of(at->second));
      finding.place = task_place(task);
      add(std::move(finding));
    }
  }

  // Objects of the suite that are called the same: a result about one is read as one about the
  // other.
  void find_namesakes() {
    std::map<std::string, std::map<std::string, std::vector<std::uint32_t>>> users;
    for (const std::uint32_t task : scope_) {
      for (const plan::BodyRecord& body : plan_.bodies(plan_.tasks()[task])) {
        if (static_cast<plan::BodyKind>(body.kind) != plan::BodyKind::kObject) continue;
        const std::string object(plan_.text(plan_.objects()[body.index].name));
        const auto words = compilation_.called.find(object);
        if (words != compilation_.called.end()) users[words->second][object].push_back(task);
      }
    }
    for (const auto& [words, objects] : users) {
      if (objects.size() < 2) continue;
      // The one that is used least is the stranger.
      const auto odd = std::min_element(
          objects.begin(), objects.end(),
          [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); });
      std::string others;
      for (const auto& [object, tasks] : objects) {
        if (object != odd->first) others += (others.empty() ? "`" : ", `") + object + "`";
      }
      Finding finding;
      finding.kind = Kind::kNamesake;
      for (const std::uint32_t task : odd->second) finding.tasks.push_back(name_of(task));
      finding.message =
          fmt::format("\"{}\" is `{}` here and {} in other tasks", words, odd->first, others);
      finding.place = task_place(odd->second.front());
      add(std::move(finding));
    }
  }

  // One finding for each place where such a rule is written.
  struct Rule {
    Kind kind;
    std::string_view metric, message;
    bool operator<(const Rule& other) const { return kind < other.kind; }
  };
  void add_rule(const Rule& rule_kind, std::uint32_t task, std::uint32_t start = 0) {
    const plan::SpanRecord* span = rule(plan_.tasks()[task], rule_kind.metric);
    const auto key =
        std::pair(rule_kind.kind, span == nullptr ? std::pair(plan::kNone, plan::kNone)
                                                  : std::pair(span->text, span->begin));
    const auto [at, is_new] = rules_.try_emplace(key, audit_.findings.size());
    if (is_new) {
      Finding finding;
      finding.kind = rule_kind.kind;
      finding.message = std::string(rule_kind.message);
      if (start != 0)
        finding.message += fmt::format(", where `{}` begins as in start {}", name_of(task), start);
      finding.place = place(span);
      add(std::move(finding));
    }
    audit_.findings[at->second].tasks.push_back(name_of(task));
  }

  Status find_rules() {
    constexpr Rule kTarget = {Kind::kWrongCountsTarget, "wrong",
                              "`wrong` is true when nothing but the target was moved"};
    constexpr Rule kAtEnd = {Kind::kWrongAtEnd, "wrong",
                             "`wrong` forgets what was moved and put back; other metrics of the "
                             "same judge remember"};
    constexpr Rule kGrasp = {Kind::kEndsInGrasp, "success",
                             "`success` counts steps of a grasp that have to include the last one"};
    constexpr Rule kOnTable = {
        Kind::kBeside, "success",
        "`success` is true of a source that lies on the table, its box clear of the target's"};
    constexpr Rule kOnFixture = {Kind::kOnFixture, "success",
                                 "`success` is true of a source that a fixture alone holds up, its "
                                 "box clear of the target's"};
    constexpr Rule kHeld = {
        Kind::kHeld, "success",
        "`success` is true of a source that both fingers hold above the target, or in "
        "it, and nothing else touches"};
    constexpr Rule kOneOnTable = {Kind::kBeside, "success",
                                  "`success` is true when one of the things that are put somewhere "
                                  "lies on the table, its box clear of where it belongs"};
    constexpr Rule kOneHeld = {Kind::kHeld, "success",
                               "`success` is true when one of the things that are put somewhere is "
                               "still held above it, or in it, and nothing else touches it"};
    constexpr Rule kAir = {Kind::kInTheAir, "success",
                           "`success` is true of a source in the air that nothing touches: thrown, or "
                           "falling"};
    constexpr Rule kTouched = {Kind::kTouchedOnce, "success",
                               "`success` counts a touch of an earlier step, whatever is so at the "
                               "last one"};
    constexpr Rule kBegun = {Kind::kHoldsAtStart, "success",
                             "`success` is true before anything has moved: things begin so"};
    FixtureStarts fixtures(compilation_, plan_);
    for (const std::uint32_t index : scope_) {
      const plan::TaskRecord& task = plan_.tasks()[index];
      const auto metrics = plan_.metrics(task);
      if (const auto wrong = plan_.find_metric(task, "wrong")) {
        PROBE_ASSIGN(const BrokenIn counts, wrong_counts_target(plan_, index, *wrong));
        if (counts) add_rule(kTarget, index, *counts);
        const auto latches = [](const plan::MetricRecord& metric) {
          return metric.readout == static_cast<std::uint32_t>(plan::Readout::kOnce);
        };
        if (metrics[*wrong].readout == static_cast<std::uint32_t>(plan::Readout::kAtEnd) &&
            std::any_of(metrics.begin(), metrics.end(), latches))
          add_rule(kAtEnd, index);
      }
      if (const auto success = plan_.find_metric(task, "success")) {
        const bool at_end =
            metrics[*success].readout == static_cast<std::uint32_t>(plan::Readout::kAtEnd);
        if (at_end && ends_in_grasp(plan_, index, *success)) add_rule(kGrasp, index);
        PROBE_ASSIGN(const BrokenIn beside, passes_beside(plan_, index, *success));
        if (beside && !goes_beside(plan_, index)) add_rule(kOnTable, index, *beside);
        PROBE_ASSIGN(const BrokenIn on_fixture, passes_on_fixture(plan_, index, *success));
        if (on_fixture) add_rule(kOnFixture, index, *on_fixture);
        PROBE_ASSIGN(const BrokenIn held, passes_held(plan_, index, *success));
        if (held) add_rule(kHeld, index, *held);
        PROBE_ASSIGN(const SeveralPut several, passes_of_several(plan_, index, *success));
        if (several.beside) add_rule(kOneOnTable, index, *several.beside);
        if (several.held) add_rule(kOneHeld, index, *several.held);
        if (several.is_tried) {
          ++audit_.tried;
        } else {
          audit_.untried.push_back(name_of(index));
        }
        PROBE_ASSIGN(const BrokenIn in_the_air, passes_in_the_air(plan_, index, *success));
        if (in_the_air) add_rule(kAir, index, *in_the_air);
        if (at_end && counts_an_earlier_touch(plan_, index, *success)) add_rule(kTouched, index);
        PROBE_ASSIGN(const bool begun, holds_at_start(plan_, index, *success, fixtures));
        if (begun) add_rule(kBegun, index);
        PROBE_TRY(find_swapped_order(index));
        PROBE_ASSIGN(std::string flaw, vm::flaw_of_solution(plan_, index));
        if (!flaw.empty()) {
          Finding finding;
          finding.kind = Kind::kSolution;
          finding.tasks = {name_of(index)};
          finding.message = std::move(flaw);
          finding.place = task_place(index);
          add(std::move(finding));
        }
      }
    }
    return {};
  }

  // By layout: what was dropped above something else comes to rest on it, or beside it.
  void find_falls() {
    std::map<std::string, Finding> by_message;
    for (const std::uint32_t index : scope_) {
      const Falls falls = falls_in(plan_, index);
      if (falls.starts == 0) continue;
      std::string message = fmt::format(
          "in {} of {} starts two objects are dropped onto one another, {} of them in start {}",
          falls.starts, falls.of, falls.first_pair, falls.first);
      Finding& finding = by_message[message];
      finding.kind = Kind::kFallsOn;
      finding.tasks.push_back(name_of(index));
      if (finding.message.empty()) finding.place = task_place(index);
      finding.message = std::move(message);
    }
    for (auto& [message, finding] : by_message) add(std::move(finding));
  }

  void find_unfelt() {
    std::map<std::uint32_t, std::vector<std::string>> users;  // by fixture
    for (const std::uint32_t index : scope_) {
      const plan::SceneRecord& scene = plan_.scenes()[plan_.tasks()[index].scene];
      for (const std::uint32_t fixture : plan::slice_of(plan_.tables().list, scene.fixtures))
        users[fixture].push_back(name_of(index));
    }
    for (const auto& [fixture, tasks] : users) {
      for (std::string& message : unfelt_in(compilation_, plan_, fixture)) {
        Finding finding;
        finding.kind = Kind::kUnfelt;
        finding.tasks = tasks;
        finding.message = std::move(message);
        finding.place = task_place(*plan_.find_task(tasks.front()));
        add(std::move(finding));
      }
    }
  }

  // "First A, then B" of which success is the same when B is put first.
  Status find_swapped_order(std::uint32_t index) {
    const plan::TaskRecord& task = plan_.tasks()[index];
    const std::string prompt = fold_case(plan_.text(task.prompt));
    std::vector<std::size_t> things;
    for (const plan::BodyRecord& body : plan_.bodies(task)) {
      if (static_cast<plan::BodyKind>(body.kind) != plan::BodyKind::kObject) continue;
      const std::string name(plan_.text(plan_.objects()[body.index].name));
      const auto called = compilation_.called.find(name);
      if (called == compilation_.called.end()) continue;
      const std::size_t at = prompt.find(fold_case(called->second));
      if (at != prompt.npos) things.push_back(at);
    }
    const std::string_view word = order_word(prompt, things);
    if (word.empty()) return {};
    PROBE_ASSIGN(const bool is_either, vm::holds_in_either_order(plan_, index));
    if (!is_either) return {};
    Finding finding;
    finding.kind = Kind::kSwappedOrder;
    finding.tasks = {name_of(index)};
    finding.message = fmt::format("`{}` says \"{}\", and `success` is true whichever is put first",
                                  name_of(index), word);
    finding.place = task_place(index);
    add(std::move(finding));
    return {};
  }

  // A word of order that stands between two things that are spoken of.
  static std::string_view order_word(const std::string& prompt,
                                     const std::vector<std::size_t>& things) {
    constexpr auto kWords = std::to_array<std::string_view>(
        {"then", "afterwards", "after that", "followed by", "finally", "before", "after"});
    for (const std::string_view word : kWords) {
      if (!has_words(prompt, word)) continue;
      const std::size_t at = prompt.find(word);
      const auto is_before = [&](std::size_t thing) { return thing < at; };
      if (std::ranges::any_of(things, is_before) && !std::ranges::all_of(things, is_before))
        return word;
    }
    return {};
  }

  // What the compiler doubts, except for the axes, which the plan has.
  void find_questions() {
    for (QuestionFinding& found : find_question_flaws(plan_, scope_)) {
      Finding finding;
      switch (found.flaw) {
        case QuestionFlaw::kNamesAnswer:
          finding.kind = Kind::kNamesAnswer;
          break;
        case QuestionFlaw::kOneAnswer:
          finding.kind = Kind::kOneAnswer;
          break;
        case QuestionFlaw::kOneLetter:
          finding.kind = Kind::kOneLetter;
          break;
        case QuestionFlaw::kCoin:
          finding.kind = Kind::kCoin;
          break;
      }
      finding.tasks = std::move(found.tasks);
      finding.message = std::move(found.message);
      finding.place = place(plan_.span_of(plan::SpanKind::kFamilies, found.family));
      add(std::move(finding));
    }
  }

  // What P1202 does not look at.
  void find_unheld() {
    std::map<std::string_view, std::vector<const UnheldWords*>> by_task;
    for (const UnheldWords& one : compilation_.unheld) by_task[one.task].push_back(&one);
    std::map<std::pair<std::string_view, std::string_view>, std::size_t> known;
    audit_.heard = scope_.size();
    for (const std::uint32_t task : scope_) {
      std::set<std::array<std::uint8_t, 32>> seen;
      for (const plan::EpisodeRecord& episode : plan_.episodes(plan_.tasks()[task])) {
        ++audit_.starts;
        if (!seen.insert(episode.start_id).second) ++audit_.repeated;
      }
    }
    for (const std::uint32_t task : scope_) {
      const auto found = by_task.find(plan_.text(plan_.tasks()[task].name));
      if (found == by_task.end()) {
        ++audit_.held;
        continue;
      }
      for (const UnheldWords* one : found->second) {
        const auto [at, is_new] = known.try_emplace({one->words, one->why}, audit_.unheld.size());
        if (is_new) audit_.unheld.push_back({one->words, one->why, {}, task_place(task)});
        std::vector<std::string>& tasks = audit_.unheld[at->second].tasks;
        if (tasks.empty() || tasks.back() != name_of(task)) tasks.push_back(name_of(task));
      }
    }
  }

  void find_warnings() {
    WarningScope scope(compilation_, plan_, audit_.suite, scope_);
    for (const Diagnostic& diagnostic : compilation_.diagnostics.items()) {
      if (diagnostic.severity == Severity::kWarning && diagnostic.code != Code::P0701 &&
          scope.concerns(diagnostic))
        add_warning(diagnostic, Span{}, std::nullopt);
    }
    for (const Silenced& silenced : compilation_.diagnostics.silenced()) {
      if (silenced.diagnostic.code != Code::P0701)
        add_warning(silenced.diagnostic, silenced.about, silenced.reason);
    }
  }

  void add_warning(const Diagnostic& diagnostic, const Span& about,
                   std::optional<std::string> reason) {
    Finding finding;
    finding.kind = Kind::kWarning;
    finding.code = std::string(info(diagnostic.code).slug);
    finding.message = diagnostic.message;
    finding.place = place(diagnostic.primary);
    finding.allowed = std::move(reason);
    if (!about.is_none()) {
      const auto task = task_before(about, diagnostic.primary);
      if (task && std::find(scope_.begin(), scope_.end(), *task) == scope_.end()) return;
      if (task) finding.tasks = {name_of(*task)};
    }
    add(std::move(finding));
  }

  // The task whose name is the last one before a place in its declaration.
  std::optional<std::uint32_t> task_before(const Span& declaration, const Span& at) const {
    const std::string& file = compilation_.sources.file(declaration.file).name();
    std::optional<std::uint32_t> best;
    std::uint32_t begin = declaration.begin;
    for (std::uint32_t task = 0; task < plan_.tasks().size(); ++task) {
      const plan::SpanRecord* span = plan_.span_of(plan::SpanKind::kTasks, task);
      if (span == nullptr || span->begin < begin || span->begin > at.begin) continue;
      if (task_place(task).file != file) continue;
      begin = span->begin;
      best = task;
    }
    return best;
  }

  const Compilation& compilation_;
  const plan::Plan& plan_;
  const plan::SuiteRecord& suite_;
  std::set<std::string> roots_;
  std::vector<std::uint32_t> scope_;  // tasks: the suite's, then those that no suite holds
  std::map<std::pair<Kind, std::pair<std::uint32_t, std::uint32_t>>, std::size_t> rules_;
  Audit audit_;
};

}  // namespace

std::string_view name(Kind kind) { return kKinds[static_cast<std::size_t>(kind)].name; }
std::string_view title(Kind kind) { return kKinds[static_cast<std::size_t>(kind)].title; }

Result<Audit> audit(const Compilation& compilation, const plan::Plan& plan, std::uint32_t suite,
                    std::span<const std::string> files) {
  return Auditor(compilation, plan, suite, files).run();
}

}  // namespace probe::audit
