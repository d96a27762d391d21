#include "runtime/run/delivery.h"

#include <map>
#include <set>
#include <tuple>

#include "runtime/base/json.h"
#include "runtime/plan/axes.h"
#include "runtime/plan/plan.h"
#include "runtime/store/not_attempted.h"

namespace probe::run {
namespace {

const std::string& prompt_of(const store::ResultRow& row) {
  return row.sent_prompt_sha256 ? *row.sent_prompt_sha256 : row.prompt_sha256;
}

const std::string& picture_of(const store::ResultRow& row) {
  return row.sent_image_sha256 ? *row.sent_image_sha256 : row.image_sha256;
}

std::string quoted(std::string_view text) { return "`" + std::string(text) + "`"; }

std::string count_of(int count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

// Names of the visible ones among `axes`.
std::string visible_axes(std::uint32_t axes) {
  std::string names;
  for (const plan::Axis axis : plan::axes_in(axes)) {
    if (info(axis).in != plan::AxisIn::kPicture) continue;
    if (!names.empty()) names += ", ";
    names += plan::axis_name(axis);
  }
  return names;
}

const char* delivery_word(DeliveryFinding::Kind kind) {
  switch (kind) {
    case DeliveryFinding::Kind::kSamePrompt:
      return "same_prompt";
    case DeliveryFinding::Kind::kManyPrompts:
      return "many_prompts";
    case DeliveryFinding::Kind::kSamePicture:
      return "same_picture";
    case DeliveryFinding::Kind::kLive:
      return "live";
    case DeliveryFinding::Kind::kNothing:
      break;
  }
  return "nothing";
}

class Detector {
 public:
  Detector(const plan::Plan& plan, std::span<const store::ResultRow> rows) : plan_(plan) {
    std::map<std::string_view, std::uint32_t> tasks;
    for (std::uint32_t i = 0; i < plan.tasks().size(); ++i) {
      tasks.emplace(plan.text(plan.tasks()[i].name), i);
    }
    for (const store::ResultRow& row : rows) {
      const auto found = tasks.find(row.task);
      if (found == tasks.end()) continue;
      ++(store::is_not_attempted(row) ? not_attempted_ : row.invalid ? invalid_ : valid_);
      // Before the first request nothing was sent, and a row without a picture never got so far.
      if (row.image_sha256.empty()) continue;
      rows_[found->second].push_back(&row);
    }
  }

  std::vector<DeliveryFinding> find() {
    if (valid_ == 0) {
      std::string counts;
      if (invalid_ > 0) counts += ", " + count_of(invalid_, "episode") + " invalid";
      if (not_attempted_ > 0)
        counts += ", " + count_of(not_attempted_, "episode") + " not attempted";
      add({DeliveryFinding::Kind::kNothing, "", "", "", 0, invalid_,
           "no episode is valid" + counts + ": what reached the policy cannot be said"});
    }
    for (const auto& [task, rows] : rows_) {
      check_prompt(task, rows);
      check_pictures(task, rows);
    }
    return std::move(findings_);
  }

 private:
  std::string_view name(std::uint32_t task) const { return plan_.text(plan_.tasks()[task].name); }
  std::string_view prompt(std::uint32_t task) const {
    return plan_.text(plan_.tasks()[task].prompt);
  }

  void check_prompt(std::uint32_t task, const std::vector<const store::ResultRow*>& rows) {
    std::set<std::string_view> sent;
    for (const store::ResultRow* row : rows) sent.insert(prompt_of(*row));
    if (sent.size() > 1) {
      add({DeliveryFinding::Kind::kManyPrompts, std::string(name(task)), "", "",
           static_cast<int>(sent.size()), static_cast<int>(rows.size()),
           "task " + quoted(name(task)) + ": its one instruction reached the policy as " +
               std::to_string(sent.size()) + " different texts"});
    }
    for (const std::string_view text : sent) {
      // Each text is compared with the first task that sent it, so a hundred tasks that send the
      // same are a hundred findings and not five thousand.
      const auto [first, is_first] = first_with_.emplace(text, task);
      if (is_first || prompt(first->second) == prompt(task)) continue;
      const auto count = static_cast<int>(rows.size());
      add({DeliveryFinding::Kind::kSamePrompt, std::string(name(task)),
           std::string(name(first->second)), "", count, count,
           "tasks " + quoted(name(task)) + " and " + quoted(name(first->second)) +
               " have different instructions (\"" + std::string(prompt(task)) + "\", \"" +
               std::string(prompt(first->second)) + "\"), but the policy was sent the same text"});
    }
  }

  void check_pictures(std::uint32_t task, const std::vector<const store::ResultRow*>& rows) {
    const plan::TaskRecord& record = plan_.tasks()[task];
    const std::string axes = visible_axes(record.axes);
    const auto baseline = rows_.find(record.baseline);
    if (axes.empty() || baseline == rows_.end()) return;
    std::map<std::pair<int, int>, const store::ResultRow*> others;
    for (const store::ResultRow* row : baseline->second) others[{row->episode, row->seed}] = row;
    int compared = 0, same = 0;
    for (const store::ResultRow* row : rows) {
      const auto other = others.find({row->episode, row->seed});
      if (other == others.end() || other->second->start_id == row->start_id) continue;
      ++compared;
      if (picture_of(*other->second) == picture_of(*row)) ++same;
    }
    if (same == 0) return;
    add({DeliveryFinding::Kind::kSamePicture, std::string(name(task)),
         std::string(name(record.baseline)), axes, same, compared,
         "task " + quoted(name(task)) + " differs from its baseline " +
             quoted(name(record.baseline)) + " in " + axes + ", but in " + std::to_string(same) +
             " of " + count_of(compared, "episode") +
             " the policy's first picture is the baseline's"});
  }

  void add(DeliveryFinding finding) { findings_.push_back(std::move(finding)); }

  const plan::Plan& plan_;
  int valid_ = 0, invalid_ = 0, not_attempted_ = 0;
  std::map<std::uint32_t, std::vector<const store::ResultRow*>> rows_;  // by task
  std::map<std::string_view, std::uint32_t> first_with_;  // a sent text: its first task
  std::vector<DeliveryFinding> findings_;
};

}  // namespace

std::vector<DeliveryFinding> check_delivery(const plan::Plan& plan,
                                            std::span<const store::ResultRow> rows) {
  return Detector(plan, rows).find();
}

std::string to_json(std::span<const DeliveryFinding> findings) {
  auto array = Json::array();
  for (const DeliveryFinding& finding : findings) {
    array.push_back({{"kind", delivery_word(finding.kind)},
                     {"task", finding.task},
                     {"other", finding.other},
                     {"axes", finding.axes},
                     {"episodes", finding.episodes},
                     {"compared", finding.compared},
                     {"sentence", finding.sentence}});
  }
  return array.dump(1);
}

}  // namespace probe::run
