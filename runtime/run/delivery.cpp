#include "runtime/run/delivery.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <unordered_map>

#include "runtime/base/json.h"
#include "runtime/plan/axes.h"
#include "runtime/plan/later.h"
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
    // Nothing has moved by itself yet where the first picture is made.
    if (info(axis).in != plan::AxisIn::kPicture || axis == plan::Axis::kMotion) continue;
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
    case DeliveryFinding::Kind::kNeverSaid:
      return "never_said";
    case DeliveryFinding::Kind::kLive:
      return "live";
    case DeliveryFinding::Kind::kNothing:
      break;
  }
  return "nothing";
}

}  // namespace

class Delivery::Detector {
 public:
  explicit Detector(const plan::Plan& plan) : plan_(plan) {
    for (std::uint32_t i = 0; i < plan.tasks().size(); ++i) {
      const plan::TaskRecord& record = plan.tasks()[i];
      tasks_.emplace(plan.text(record.name), i);
      if (record.baseline == plan::kNone || visible_axes(record.axes).empty()) continue;
      shown_.insert({i, record.baseline});
    }
  }

  void add(const store::ResultRow& row) {
    const auto found = tasks_.find(row.task);
    if (found == tasks_.end()) return;
    ++(store::is_not_attempted(row) ? not_attempted_ : row.invalid ? invalid_ : valid_);
    if (row.told_at && !row.invalid) {
      Told& told = told_[found->second];
      ++told.rows;
      told.most = std::max(told.most, row.told_at->size());
    }
    // Before the first request nothing was sent, and a row without a picture never got so far.
    if (row.image_sha256.empty()) return;
    Sent& sent = sent_[found->second];
    ++sent.rows;
    sent.prompts.insert(prompt_of(row));
    // Pictures are compared of few tasks.
    if (shown_.contains(found->second)) {
      sent.pictures.push_back({{row.episode, row.seed},
                               texts_.emplace(row.start_id, texts_.size()).first->second,
                               texts_.emplace(picture_of(row), texts_.size()).first->second});
    }
  }

  std::vector<DeliveryFinding> find() {
    findings_.clear();
    first_with_.clear();
    if (valid_ == 0) {
      std::string counts;
      if (invalid_ > 0) counts += ", " + count_of(invalid_, "episode") + " invalid";
      if (not_attempted_ > 0)
        counts += ", " + count_of(not_attempted_, "episode") + " not attempted";
      add({DeliveryFinding::Kind::kNothing, "", "", "", 0, invalid_,
           "no episode is valid" + counts + ": what reached the policy cannot be said"});
    }
    for (const auto& [task, sent] : sent_) {
      check_prompt(task, sent);
      check_pictures(task, sent);
    }
    for (const auto& [task, told] : told_) check_later(task, told);
    return std::move(findings_);
  }

 private:
  // Of a task whose instruction changes: how many sentences behind the first were said at most.
  struct Told {
    std::size_t most = 0;
    int rows = 0;
  };
  // Of an episode, texts by their numbers.
  struct Picture {
    std::pair<int, int> key;  // episode, seed
    std::size_t start = 0, picture = 0;
    bool operator<(const Picture& other) const { return key < other.key; }
  };
  // Of a task.
  struct Sent {
    std::set<std::string> prompts;
    int rows = 0;
    std::vector<Picture> pictures;
  };

  std::string_view name(std::uint32_t task) const { return plan_.text(plan_.tasks()[task].name); }
  std::string_view prompt(std::uint32_t task) const {
    return plan_.text(plan_.tasks()[task].prompt);
  }

  void check_prompt(std::uint32_t task, const Sent& sent) {
    if (sent.prompts.size() > 1) {
      add({DeliveryFinding::Kind::kManyPrompts, std::string(name(task)), "", "",
           static_cast<int>(sent.prompts.size()), sent.rows,
           "task " + quoted(name(task)) + ": its one instruction reached the policy as " +
               std::to_string(sent.prompts.size()) + " different texts"});
    }
    for (const std::string& text : sent.prompts) {
      // Each text is compared with the first task that sent it, so a hundred tasks that send the
      // same are a hundred findings and not five thousand.
      const auto [first, is_first] = first_with_.emplace(text, task);
      if (is_first || prompt(first->second) == prompt(task)) continue;
      add({DeliveryFinding::Kind::kSamePrompt, std::string(name(task)),
           std::string(name(first->second)), "", sent.rows, sent.rows,
           "tasks " + quoted(name(task)) + " and " + quoted(name(first->second)) +
               " have different instructions (\"" + std::string(prompt(task)) + "\", \"" +
               std::string(prompt(first->second)) + "\"), but the policy was sent the same text"});
    }
  }

  // What was never said cannot make a difference.
  void check_later(std::uint32_t task, const Told& told) {
    const auto sentences = plan::later_of(plan_.tables(), task);
    for (std::size_t k = told.most; k < sentences.size(); ++k) {
      add({DeliveryFinding::Kind::kNeverSaid, std::string(name(task)), "", "", told.rows, told.rows,
           "task " + quoted(name(task)) + ": its later sentence \"" +
               std::string(plan_.text(sentences[k].text)) + "\" was said in none of " +
               count_of(told.rows, "episode") + ", because its condition never held"});
    }
  }

  void check_pictures(std::uint32_t task, const Sent& sent) {
    const plan::TaskRecord& record = plan_.tasks()[task];
    const std::string axes = visible_axes(record.axes);
    const auto baseline = sent_.find(record.baseline);
    if (axes.empty() || baseline == sent_.end()) return;
    std::vector<Picture> others = baseline->second.pictures;
    std::sort(others.begin(), others.end());
    int compared = 0, same = 0;
    for (const Picture& one : sent.pictures) {
      const auto other = std::lower_bound(others.begin(), others.end(), one);
      if (other == others.end() || other->key != one.key || other->start == one.start) continue;
      ++compared;
      if (other->picture == one.picture) ++same;
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
  std::map<std::string, std::uint32_t, std::less<>> tasks_;
  std::set<std::uint32_t> shown_;  // whose pictures are compared
  int valid_ = 0, invalid_ = 0, not_attempted_ = 0;
  std::map<std::uint32_t, Sent> sent_;                  // by task
  std::map<std::uint32_t, Told> told_;                  // by task
  std::unordered_map<std::string, std::size_t> texts_;  // with their numbers
  std::map<std::string_view, std::uint32_t> first_with_;  // a sent text: its first task
  std::vector<DeliveryFinding> findings_;
};

Delivery::Delivery(const plan::Plan& plan) : detector_(std::make_unique<Detector>(plan)) {}
Delivery::~Delivery() = default;
Delivery::Delivery(Delivery&&) noexcept = default;
void Delivery::add(const store::ResultRow& row) { detector_->add(row); }
std::vector<DeliveryFinding> Delivery::findings() const { return detector_->find(); }

std::vector<DeliveryFinding> check_delivery(const plan::Plan& plan,
                                            std::span<const store::ResultRow> rows) {
  Delivery delivery(plan);
  for (const store::ResultRow& row : rows) delivery.add(row);
  return delivery.findings();
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
