#include "runtime/report/episode_documents.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>
#include <unordered_map>

#include "runtime/base/json.h"
#include "runtime/plan/fixtures.h"
#include "runtime/plan/roles.h"
#include "runtime/rejudge/explain.h"
#include "runtime/run/workers.h"
#include "runtime/store/stored_trace.h"

namespace probe::report {
namespace {

// A distance is written for every so many control steps.
constexpr std::size_t kEvery = 2;
// Of the way from open to shut: what is held keeps the fingers apart.
constexpr double kClosed = 0.2;
// A joint that moves by less in an episode is not told of: cm or degrees.
constexpr double kStill = 0.1;
// Notes of traces that could not be read; the rest is one number.
constexpr std::size_t kNotes = 5;

// Adds control step `step`, one-based, to spans that are written "first-last,first-last".
class Spans {
 public:
  void add(std::size_t step) {
    if (!spans_.empty() && spans_.back().second + 1 == step) {
      spans_.back().second = step;
    } else {
      spans_.emplace_back(step, step);
    }
  }
  bool empty() const { return spans_.empty(); }
  std::string text() const {
    std::string text;
    for (const auto& [first, last] : spans_)
      text += fmt::format("{}{}-{}", text.empty() ? "" : ",", first, last);
    return text;
  }

 private:
  std::vector<std::pair<std::size_t, std::size_t>> spans_;
};

void append_record(std::string& text, const std::string& key, const Spans& spans) {
  if (spans.empty()) return;
  text += fmt::format("{}{}:{}", text.empty() ? "" : ";", key, spans.text());
}

// Links of the arm touch each other and things rest on the surface all the time: neither says what
// happened. Fingers come after the surface in the plan's order, see BodyRecord.
std::size_t surface_of(const store::TraceHeader& header) {
  const auto at = std::find(header.bodies.begin(), header.bodies.end(), "surface");
  return static_cast<std::size_t>(at - header.bodies.begin());
}

// Texts that occur often, each once.
class TextTable {
 public:
  int add(const std::string& text) {
    const auto [at, is_new] = index_.try_emplace(text, static_cast<int>(texts_.size()));
    if (is_new) texts_.push_back(text);
    return at->second;
  }
  const std::vector<std::string>& texts() const { return texts_; }

 private:
  std::unordered_map<std::string, int> index_;
  std::vector<std::string> texts_;
};

Json why_json(const std::vector<rejudge::MetricWhy>& metrics, TextTable& texts) {
  Json list = Json::array();
  for (const rejudge::MetricWhy& metric : metrics) {
    Json conditions = Json::array();
    for (const rejudge::Condition& c : metric.conditions) {
      conditions.push_back({c.line, texts.add(c.text), texts.add(c.bodies), texts.add(c.measured),
                            c.is_number ? -1 : static_cast<int>(c.truth), c.decides ? 1 : 0,
                            c.alike});
    }
    list.push_back({metric.name, metric.shown, metric.when,
                    metric.file.empty() ? -1 : texts.add(metric.file), metric.line,
                    std::move(conditions)});
  }
  return list;
}

// Which episodes are explained: round after round one of each task and policy, failures before
// successes, until there are `most`.
std::vector<char> chosen_whys(std::span<const EpisodeTrace> episodes, std::size_t most) {
  std::map<std::tuple<int, std::string>, std::vector<std::size_t>> groups;
  const auto succeeded = [&](std::size_t i) {
    const auto& metrics = episodes[i].row->metrics;
    return std::any_of(metrics.begin(), metrics.end(), [](const store::MetricValue& m) {
      return m.name == "success" && m.value != 0;
    });
  };
  for (std::size_t i = 0; i < episodes.size(); ++i) {
    if (episodes[i].row != nullptr && !episodes[i].row->invalid)
      groups[{episodes[i].task, episodes[i].row->policy}].push_back(i);
  }
  std::size_t rounds = 0;
  for (auto& [key, group] : groups) {
    std::stable_partition(group.begin(), group.end(), [&](std::size_t i) { return !succeeded(i); });
    rounds = std::max(rounds, group.size());
  }
  std::vector<char> chosen(episodes.size(), 0);
  std::size_t count = 0;
  for (std::size_t round = 0; round < rounds && count < most; ++round) {
    for (const auto& [key, group] : groups) {
      if (round >= group.size() || count >= most) continue;
      chosen[group[round]] = 1;
      ++count;
    }
  }
  return chosen;
}

// What one thread found of one episode.
struct Reading {
  std::string timeline;
  std::vector<std::string> bodies;
  std::vector<TimelineJoint> joints;
  std::vector<rejudge::MetricWhy> why;
  std::optional<rejudge::EpisodeEvents> events;
  std::string problem;
};

double in_shown_unit(const TimelineJoint& joint, double position) {
  const double value = position * (joint.slides ? 100 : 180 / std::numbers::pi);
  return std::nearbyint(value * 10) / 10 + 0.0;  // never a negative zero
}

std::vector<TimelineJoint> joints_of(const plan::Plan& plan, const plan::TaskRecord& task) {
  const plan::SceneRecord& scene = plan.scenes()[task.scene];
  std::vector<TimelineJoint> joints;
  for (const plan::FixtureJointRecord* joint : plan::joints_of(plan.tables(), scene))
    joints.push_back({"", plan::slides(*joint), joint->lower, joint->upper});
  const auto names = plan::joint_names_of(plan.tables(), scene);
  for (std::size_t i = 0; i < joints.size(); ++i) joints[i].name = names[i];
  return joints;
}

Json joints_json(const std::vector<TimelineJoint>& joints) {
  Json list = Json::array();
  for (const TimelineJoint& joint : joints) {
    list.push_back({joint.name, joint.slides ? "cm" : "deg", in_shown_unit(joint, joint.lower),
                    in_shown_unit(joint, joint.upper)});
  }
  return list;
}

Reading read_episode(const EpisodeTrace& episode, std::span<const std::string> metrics,
                     const rejudge::EventMetrics& asked, bool explained) {
  Reading reading;
  const auto trace = store::read_stored_trace(*episode.row);
  if (!trace) {
    reading.problem = to_text(trace.failure());
    return reading;
  }
  const auto task = episode.plan->find_task(episode.row->task);
  Ends ends;
  if (task) {
    const plan::TaskRoles roles =
        plan::roles_of(episode.plan->tables(), episode.plan->tasks()[*task]);
    ends = {roles.source, roles.target};
    reading.joints = joints_of(*episode.plan, episode.plan->tasks()[*task]);
  }
  reading.timeline = encode_timeline(*trace, metrics, ends, reading.joints);
  reading.bodies = trace->header.bodies;
  if (task && episode.events != nullptr) {
    auto events = rejudge::events_of(*episode.events, *task, *trace, asked);
    if (events) {
      reading.events = std::move(*events);
    } else {
      reading.problem = to_text(events.failure());
    }
  }
  if (!explained) return reading;
  if (!task || trace->header.plan_root != episode.plan->root()) return reading;
  auto why = rejudge::explain(*episode.plan, *task, *trace);
  if (why) {
    reading.why = std::move(*why);
  } else {
    reading.problem = to_text(why.failure());
  }
  return reading;
}

}  // namespace

std::string encode_timeline(const store::Trace& trace, std::span<const std::string> metrics,
                            Ends ends, std::span<const TimelineJoint> joints) {
  std::string text;
  for (std::size_t m = 0; m < trace.header.metrics.size(); ++m) {
    const auto& metric = trace.header.metrics[m];
    const auto at = std::find(metrics.begin(), metrics.end(), metric.name);
    if (!metric.is_bool || at == metrics.end()) continue;
    Spans spans;
    for (std::size_t i = 0; i < trace.steps.size(); ++i) {
      if (m < trace.steps[i].metrics.size() && trace.steps[i].metrics[m] != 0) spans.add(i + 1);
    }
    append_record(text, fmt::format("m{}", at - metrics.begin()), spans);
  }
  Spans closed;
  std::map<std::pair<int, int>, Spans> contacts;
  const std::size_t surface = surface_of(trace.header);
  for (std::size_t i = 0; i < trace.steps.size(); ++i) {
    const vm::StepSample& sample = trace.steps[i].sample;
    if (sample.grip > kClosed) closed.add(i + 1);
    for (const vm::ContactSample& contact : sample.contacts) {
      // Something that is handled, and not what it rests on.
      if (contact.a >= surface || contact.b == surface) continue;
      contacts[{contact.a, contact.b}].add(i + 1);
    }
  }
  append_record(text, "g", closed);
  for (const auto& [pair, spans] : contacts)
    append_record(text, fmt::format("c{}.{}", pair.first, pair.second), spans);
  std::string distances;
  for (std::size_t i = 0; i < trace.steps.size(); i += kEvery) {
    const auto& bodies = trace.steps[i].sample.bodies;
    if (std::max(ends.source, ends.target) >= bodies.size()) break;
    const double cm = 100 * (bodies[ends.source].position - bodies[ends.target].position).norm();
    distances += fmt::format("{}{:.1f}", distances.empty() ? "" : ",", cm);
  }
  if (!distances.empty()) text += fmt::format("{}d:{}", text.empty() ? "" : ";", distances);
  const std::size_t all = trace.header.joints.size();
  for (std::size_t j = 0; j < joints.size() && joints.size() <= all; ++j) {
    std::string values;
    double low = 0, high = 0;
    for (std::size_t i = 0; i < trace.steps.size(); i += kEvery) {
      const double at =
          in_shown_unit(joints[j], trace.steps[i].sample.joints[all - joints.size() + j].position);
      low = i == 0 ? at : std::min(low, at);
      high = i == 0 ? at : std::max(high, at);
      values += fmt::format("{}{:.1f}", values.empty() ? "" : ",", at);
    }
    if (high - low >= kStill) text += fmt::format("{}j{}:{}", text.empty() ? "" : ";", j, values);
  }
  return text;
}

std::string encode_events(const rejudge::EpisodeEvents& events,
                          std::span<const std::string> names) {
  std::string text;
  for (std::size_t n = 0; n < names.size(); ++n) {
    std::string marks;
    for (const rejudge::EventMark& mark : events.marks) {
      if (mark.name != names[n]) continue;
      marks += fmt::format("{}{}", marks.empty() ? "" : ",", mark.step);
      for (const std::uint16_t body : mark.of) marks += fmt::format(".{}", body);
    }
    if (!marks.empty()) text += fmt::format("{}e{}:{}", text.empty() ? "" : ";", n, marks);
  }
  return text;
}

EpisodeDocuments episode_documents(std::span<const EpisodeTrace> episodes,
                                   std::span<const std::string> metrics, std::size_t task_count,
                                   const EpisodeDocumentOptions& options) {
  EpisodeDocuments documents{.timelines = "{}", .whys = "{}", .notes = {}};
  if (!options.traces || episodes.empty()) return documents;
  const std::vector<char> explained = chosen_whys(episodes, options.explained);
  std::vector<Reading> readings(episodes.size());
  const auto work = [&](std::size_t i) -> Status {
    if (episodes[i].row != nullptr && !episodes[i].row->trace.empty())
      readings[i] = read_episode(episodes[i], metrics, options.events, explained[i] != 0);
    return {};
  };
  // No job fails: what cannot be read is noted.
  (void)run::run_jobs(episodes.size(), std::max(1, options.jobs),
                      [&]() -> Result<run::Worker> { return run::Worker(work); });

  std::vector<std::vector<std::string>> bodies(task_count);
  std::vector<Json> joints(task_count, Json::array());
  bool has_joints = false;
  std::vector<std::string> names = options.events.events;
  names.insert(names.end(), options.events.subgoals.begin(), options.events.subgoals.end());
  documents.events.resize(readings.size());
  Json lines = Json::array(), whys = Json::object();
  TextTable texts;
  std::size_t problems = 0;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    Reading& reading = readings[i];
    if (!reading.problem.empty() && problems++ < kNotes)
      documents.notes.push_back("no timeline of one episode: " + reading.problem);
    if (reading.events) {
      const std::string told = encode_events(*reading.events, names);
      if (!told.empty()) reading.timeline += (reading.timeline.empty() ? "" : ";") + told;
      documents.events[i] = std::move(reading.events);
    }
    lines.push_back(reading.timeline.empty() ? Json(0) : Json(std::move(reading.timeline)));
    const auto task = static_cast<std::size_t>(episodes[i].task);
    if (task < task_count && bodies[task].empty()) bodies[task] = std::move(reading.bodies);
    if (task < task_count && joints[task].empty() && !reading.joints.empty()) {
      joints[task] = joints_json(reading.joints);
      has_joints = true;
    }
    if (!reading.why.empty()) whys[std::to_string(i)] = why_json(reading.why, texts);
  }
  if (problems > kNotes)
    documents.notes.push_back(
        fmt::format("{} further episodes without a timeline", problems - kNotes));
  const auto dumped = [](const Json& json) { return json.dump(); };
  Json timelines = {{"every", kEvery}, {"bodies", bodies}};
  if (has_joints) timelines["joints"] = joints;
  if (!names.empty()) {
    Json& told = timelines["events"] = Json::array();
    for (std::size_t n = 0; n < names.size(); ++n) {
      told.push_back({rejudge::event_words(names[n]), n >= options.events.events.size() ? 1 : 0});
    }
  }
  timelines["e"] = std::move(lines);
  documents.timelines = dumped(timelines);
  documents.whys = dumped({{"strings", texts.texts()}, {"e", std::move(whys)}});
  return documents;
}

}  // namespace probe::report
