#include "runtime/report/knowledge.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

#include "runtime/base/numbering.h"
#include "runtime/plan/questions.h"
#include "runtime/report/page_data.h"

namespace probe::report {
namespace {

const plan::Plan& plan_of(const Benchmark& benchmark, const AskedModel& model) {
  return benchmark.plan_files[static_cast<std::size_t>(model.plan)];
}

const AskedModel& model_at(const Benchmark& benchmark, int model) {
  return benchmark.models[static_cast<std::size_t>(model)];
}

// Categories are sets of a plan; a model that was asked under another plan has those of its own by
// their names.
int category_of(const Benchmark& benchmark, const plan::Plan& plan, std::uint32_t set) {
  const std::string_view name = plan.text(plan.sets()[set].name);
  for (std::size_t c = 0; c < benchmark.categories.size(); ++c) {
    if (benchmark.categories[c].name == name) return static_cast<int>(c);
  }
  return kAbsent;
}

class KnowledgeMaker {
 public:
  explicit KnowledgeMaker(const Benchmark& benchmark) : benchmark_(benchmark) {}

  Knowledge make() {
    for (std::size_t m = 0; m < benchmark_.models.size(); ++m) accuracy(static_cast<int>(m));
    goes_ = benchmark_.find_metric("intention");
    does_ = benchmark_.find_metric("success");
    if (goes_ != kAbsent && does_ != kAbsent) {
      for (std::size_t m = 0; m < benchmark_.models.size(); ++m) {
        for (std::size_t p = 0; p < benchmark_.policies.size(); ++p) {
          if (!benchmark_.policies[p].adaptive) knows(static_cast<int>(m), static_cast<int>(p));
        }
      }
      adjust_all();
    }
    return std::move(knowledge_);
  }

 private:
  using Starts = std::map<std::pair<int, int>, bool>;  // task, start -> knows

  void accuracy(int model) {
    const AskedModel& asked = model_at(benchmark_, model);
    for (const ask::ScoreRow& row : asked.scores) {
      const int category = row.set == plan::kNone
                               ? kAbsent
                               : category_of(benchmark_, plan_of(benchmark_, asked), row.set);
      if (row.set != plan::kNone && category == kAbsent) continue;
      knowledge_.accuracy.push_back({model, row.family, category, &row});
    }
  }

  void knows(int model, int policy) {
    std::map<std::uint32_t, Starts> families;
    const AskedModel& asked = model_at(benchmark_, model);
    for (std::uint32_t f = 0; f < plan_of(benchmark_, asked).families().size(); ++f) {
      if (asks_for_source(plan_of(benchmark_, asked), f)) families[f];
    }
    for (const AskedModel::Known& known : asked.known) {
      const auto family = families.find(known.family);
      if (family == families.end()) continue;
      // Several questions of a family about one start are known if all are.
      const auto [start, fresh] =
          family->second.try_emplace({known.task, known.start}, known.knows);
      if (!fresh) start->second = start->second && known.knows;
    }
    for (const auto& [family, starts] : families) {
      add({model, policy, family, kAbsent, {}, {}}, starts, benchmark_.all_tasks());
      for (std::size_t c = 0; c < benchmark_.categories.size(); ++c)
        add({model, policy, family, static_cast<int>(c), {}, {}}, starts,
            benchmark_.categories[c].tasks);
    }
  }

  // One answer stands beside every seed of its start.
  void add(KnowsRow row, const Starts& starts, const std::vector<int>& tasks) {
    PairRows pairs;
    for (const int t : tasks) {
      const Task& task = benchmark_.tasks[static_cast<std::size_t>(t)];
      const auto judges = [&](int metric) {
        return std::ranges::find(task.metrics, metric) != task.metrics.end();
      };
      if (!judges(goes_) || !judges(does_)) continue;
      int last = kAbsent;
      for (const Episode& e : benchmark_.of(row.policy, t)) {
        const auto known = starts.find({t, e.start});
        if (!e.valid() || known == starts.end()) continue;
        const bool knows = known->second, goes = e.is(goes_), does = e.is(does_);
        ++row.counts[(knows ? 4U : 0U) + (goes ? 2U : 0U) + (does ? 1U : 0U)];
        const std::uint32_t place = task.starts[static_cast<std::size_t>(e.start)].cluster;
        count_pair(pairs.at(t, place, t, e.start != last), knows, goes);
        last = e.start;
      }
    }
    if (pairs.empty()) return;
    row.contrast = pairs.contrast();
    knowledge_.knows.push_back(std::move(row));
  }

  void adjust_all() {
    std::map<std::tuple<int, int, std::uint32_t, bool>, std::vector<Contrast*>> families;
    for (KnowsRow& row : knowledge_.knows) {
      const bool is_sum = row.category == kAbsent;
      families[is_sum ? std::tuple(0, 0, 0U, true)
                      : std::tuple(row.model, row.policy, row.family, false)]
          .push_back(&row.contrast);
    }
    for (const auto& [key, members] : families) adjust(members, Adjustment::kHolm);
  }

  const Benchmark& benchmark_;
  int goes_ = kAbsent, does_ = kAbsent;
  Knowledge knowledge_;
};

// Pairs of episodes are of one start and one seed: a number that stands for the question, where a
// family asks several of a start, and for the recorded episode.
class Pairing {
 public:
  int number(const plan::Plan& plan, const AskedModel::Known& known) {
    const auto key = std::pair(words(plan, known.question), known.seed);
    return static_cast<int>(numbers_(key));
  }

 private:
  // The only question of its family and task goes with the only one of a baseline, in whatever
  // words; of several each goes with the one of the same words and options.
  static std::string words(const plan::Plan& plan, std::uint32_t index) {
    const plan::QuestionRecord& question = plan.questions()[index];
    const auto is_beside = [&](std::uint32_t other) {
      return other < plan.questions().size() && plan.questions()[other].task == question.task &&
             plan.questions()[other].family == question.family;
    };
    if (!is_beside(index + 1) && (index == 0 || !is_beside(index - 1))) return "";
    std::string text(plan.text(question.text));
    for (const plan::OptionRecord& option : plan::slice_of(plan.tables().options, question.options))
      text += "\n" + std::string(plan.text(option.text));
    return text;
  }

  Numbering<std::pair<std::string, int>> numbers_;
};

Json rate_json(const ask::Rate& rate) {
  if (rate.count.n == 0) return nullptr;
  return {rate.count.k, rate.count.n, rounded(rate.interval.low), rounded(rate.interval.high)};
}

Json arm_json(const ask::ArmScore& score) {
  Json json = {{"circular", rate_json(score.circular)},
               {"plain", rate_json(score.plain)},
               {"rows", score.rows},
               {"unclear", score.unclear},
               {"refused", score.refused},
               {"empty", score.empty},
               {"invalid", score.invalid},
               {"incomplete", score.incomplete}};
  if (score.likely_circular) json["likely_circular"] = rate_json(*score.likely_circular);
  if (score.likely_plain) json["likely_plain"] = rate_json(*score.likely_plain);
  if (score.copied) {
    json["copied"] = rounded(*score.copied);
    json["copies"] = score.copies;
  }
  return json;
}

}  // namespace

std::int64_t KnowsRow::episodes() const {
  return std::accumulate(counts.begin(), counts.end(), std::int64_t{0});
}

std::int64_t KnowsRow::with(bool knows, bool goes) const {
  const std::size_t at = (knows ? 4U : 0U) + (goes ? 2U : 0U);
  return counts[at] + counts[at + 1];
}

FamilyNames::FamilyNames(const Benchmark& benchmark) {
  std::map<std::string, std::string> worded;  // by name: the words of the first of that name
  for (const AskedModel& model : benchmark.models) {
    const plan::Plan& plan = plan_of(benchmark, model);
    std::vector<std::string>& names = names_.emplace_back();
    for (std::uint32_t f = 0; f < plan.families().size(); ++f) {
      std::string name = family_name(plan, f);
      const std::string words(plan.text(plan.families()[f].text));
      if (worded.try_emplace(name, words).first->second != words) name += " \"" + words + "\"";
      names.push_back(std::move(name));
    }
  }
}

Benchmark models_as_policies(const Benchmark& benchmark) {
  Benchmark out;
  out.things = "questions";
  out.objects = benchmark.objects;
  out.plans = benchmark.plans;
  out.notes = benchmark.notes;
  std::map<std::string, int> metrics;
  std::map<std::pair<int, int>, int> tasks;  // task of the benchmark and metric
  const FamilyNames names(benchmark);
  const auto metric_of = [&](int model, std::uint32_t family) {
    const std::string& name = names.of(model, family);
    const auto [known, fresh] = metrics.try_emplace(name, static_cast<int>(out.metrics.size()));
    if (fresh) out.metrics.push_back({name, true, +1});
    return known->second;
  };
  Pairing pairing;
  const auto count = static_cast<int>(benchmark.models.size());
  for (int m = 0; m < count; ++m) {
    for (const AskedModel::Known& known : model_at(benchmark, m).known)
      tasks.try_emplace({known.task, metric_of(m, known.family)}, 0);
  }
  for (auto& [key, index] : tasks) {
    index = static_cast<int>(out.tasks.size());
    out.tasks.push_back(benchmark.tasks[static_cast<std::size_t>(key.first)]);
    out.tasks.back().metrics = {key.second};
  }
  for (const auto& [key, index] : tasks) {
    Task& task = out.tasks[static_cast<std::size_t>(index)];
    const auto baseline = tasks.find({task.baseline, key.second});
    task.baseline = baseline == tasks.end() ? kAbsent : baseline->second;
    if (task.baseline == kAbsent) task.unpaired.clear();
  }
  for (Category category : benchmark.categories) {
    std::vector<int> members;
    for (const auto& [key, index] : tasks) {
      if (std::ranges::find(category.tasks, key.first) != category.tasks.end())
        members.push_back(index);
    }
    category.tasks = std::move(members);
    out.categories.push_back(std::move(category));
  }
  for (int m = 0; m < count; ++m) {
    const AskedModel& model = model_at(benchmark, m);
    Policy policy{model.name, model.label, Role::kModel, {}};
    for (const AskedModel::Known& known : model.known) {
      const int metric = metric_of(m, known.family);
      Episode episode;
      episode.policy = static_cast<int>(out.policies.size());
      episode.task = tasks.at({known.task, metric});
      episode.start = known.start;
      episode.plan = model.plan;
      episode.truths.set(static_cast<std::size_t>(metric), known.knows);
      episode.seed = pairing.number(plan_of(benchmark, model), known);
      episode.shared = known.shared;
      out.episodes.push_back(std::move(episode));
    }
    out.policies.push_back(std::move(policy));
  }
  index_episodes(out);
  return out;
}

Knowledge make_knowledge(const Benchmark& benchmark) { return KnowledgeMaker(benchmark).make(); }

std::string question_name(const Benchmark& benchmark, const KnowsRow& row) {
  return family_name(plan_of(benchmark, model_at(benchmark, row.model)), row.family);
}

std::string knows_sentence(const Benchmark& benchmark, const KnowsRow& row) {
  const std::string& model = model_at(benchmark, row.model).label;
  const std::string& policy = benchmark.policies[static_cast<std::size_t>(row.policy)].label;
  const std::int64_t lost = row.with(true, false) + row.with(false, false);
  if (lost == 0) return fmt::format("in every episode {} went for the right object", policy);
  return fmt::format(
      "of the {} episodes in which {} did not go for the right object, {} named it in {}", lost,
      policy, model, row.with(true, false));
}

void add_knowledge(const Benchmark& benchmark, const Knowledge& knowledge, Json& data) {
  if (benchmark.models.empty()) return;
  data["models"] = Json::array();
  for (const AskedModel& model : benchmark.models) {
    const plan::Plan& plan = plan_of(benchmark, model);
    Json families = Json::array();
    for (std::uint32_t f = 0; f < plan.families().size(); ++f) {
      const plan::FamilyRecord& family = plan.families()[f];
      families.push_back({{"name", family_name(plan, f)},
                          {"form", plan::find_form(family.form)->word},
                          {"moment", plan::find_moment(family.moment)->words},
                          {"text", plan.text(family.text)}});
    }
    data["models"].push_back({{"name", model.name},
                              {"label", model.label},
                              {"plan", model.plan},
                              {"answers", model.answers},
                              {"invalid", model.invalid},
                              {"left_out", model.left_out},
                              {"families", std::move(families)}});
  }
  Json accuracy = Json::array();
  for (const AccuracyRow& row : knowledge.accuracy) {
    Json one = {{"model", row.model}, {"family", row.family}, {"category", row.category}};
    for (const ask::Arm arm : {ask::Arm::kPicture, ask::Arm::kBlind, ask::Arm::kPrior}) {
      if (const auto& score = row.score->of(arm)) one[ask::word_of(arm)] = arm_json(*score);
    }
    const auto put_floor = [&](const char* name, const std::optional<double>& floor) {
      if (floor) one[name] = rounded(*floor);
    };
    put_floor("random", row.score->floors.random_circular);
    put_floor("first", row.score->floors.first_circular);
    accuracy.push_back(std::move(one));
  }
  Json knows = Json::array();
  for (const KnowsRow& row : knowledge.knows) {
    Json one = {{"model", row.model},
                {"policy", row.policy},
                {"family", row.family},
                {"category", row.category},
                {"counts", row.counts},
                {"says", knows_sentence(benchmark, row)},
                {"starts", row.contrast.starts},
                {"diff", rounded(row.contrast.difference)},
                {"low", rounded(row.contrast.anew.interval.low)},
                {"high", rounded(row.contrast.anew.interval.high)}};
    put_answers(one, row.contrast);
    knows.push_back(std::move(one));
  }
  data["tables"]["accuracy"] = std::move(accuracy);
  data["tables"]["knows"] = std::move(knows);
}

}  // namespace probe::report
