// Bytes decide whether two records are equal; the fields are only walked to say what differs.
#include "runtime/store/trace_compare.h"

#include <algorithm>
#include <bit>

#include "runtime/base/exact_text.h"
#include "runtime/store/trace_codec.h"

namespace probe::store {
namespace {

// Keeps the first thing that differs.
class Finder {
 public:
  void real(const std::string& name, double here, double recorded) {
    if (std::bit_cast<std::uint64_t>(here) == std::bit_cast<std::uint64_t>(recorded)) return;
    keep(name + " is " + exact_text(here) + ", recorded " + exact_text(recorded));
  }
  void vec(const std::string& name, const Vec3& here, const Vec3& recorded) {
    constexpr const char* kAxes[] = {"x", "y", "z"};
    for (int i = 0; i < 3; ++i) real(name + " " + kAxes[i], here[i], recorded[i]);
  }
  void reals(const std::string& name, std::span<const double> here,
             std::span<const double> recorded, const std::vector<std::string>& of) {
    count(name, here.size(), recorded.size());
    for (std::size_t i = 0; i < std::min(here.size(), recorded.size()); ++i) {
      real(name + " of `" + (i < of.size() ? of[i] : std::to_string(i)) + "`", here[i],
           recorded[i]);
    }
  }
  void count(const std::string& name, std::size_t here, std::size_t recorded) {
    if (here != recorded) {
      keep(std::to_string(here) + " " + name + ", recorded " + std::to_string(recorded));
    }
  }
  void hash(const std::string& name, const Sha256& here, const Sha256& recorded) {
    if (here != recorded) {
      keep(name + " is " + to_hex(here).substr(0, 12) + ", recorded " +
           to_hex(recorded).substr(0, 12));
    }
  }
  void sample(const vm::StepSample& here, const vm::StepSample& recorded,
              const TraceHeader& header) {
    const auto name = [&](std::size_t body) {
      return "`" + (body < header.bodies.size() ? header.bodies[body] : std::to_string(body)) + "`";
    };
    vec("the tool centre point's", here.tcp, recorded.tcp);
    real("closedness", here.grip, recorded.grip);
    real("step", here.step, recorded.step);
    real("time", here.time, recorded.time);
    count("bodies", here.bodies.size(), recorded.bodies.size());
    for (std::size_t i = 0; i < std::min(here.bodies.size(), recorded.bodies.size()); ++i) {
      const vm::BodySample &a = here.bodies[i], &b = recorded.bodies[i];
      vec("centre of " + name(i), a.position, b.position);
      vec("origin of " + name(i), a.origin, b.origin);
      vec("velocity of " + name(i), a.velocity, b.velocity);
      vec("spin of " + name(i), a.spin, b.spin);
      for (int k = 0; k < 4; ++k) {
        real("rotation of " + name(i), a.rotation.coeffs()[k], b.rotation.coeffs()[k]);
      }
    }
    count("things that move by themselves", here.own.size(), recorded.own.size());
    for (std::size_t i = 0; i < std::min(here.own.size(), recorded.own.size()); ++i)
      vec("where its own motion has " + name(here.own[i].body), here.own[i].position,
          recorded.own[i].position);
    count("contacts", here.contacts.size(), recorded.contacts.size());
    for (std::size_t i = 0; i < std::min(here.contacts.size(), recorded.contacts.size()); ++i) {
      const vm::ContactSample &a = here.contacts[i], &b = recorded.contacts[i];
      if (a.a != b.a || a.b != b.b) {
        keep("contact of " + name(a.a) + " and " + name(a.b) + ", recorded " + name(b.a) + " and " +
             name(b.b));
      }
      vec("push of " + name(a.a) + " on " + name(a.b), a.push, b.push);
    }
  }
  // Delays that were measured are the wall clock's, and never come again.
  void live(const policy::LiveStep& here, const policy::LiveStep& recorded, bool with_delays) {
    const auto said = [](const policy::LiveStep& live) {
      const char* source = live.source == policy::LiveSource::kHeld   ? "no action"
                           : live.source == policy::LiveSource::kLate ? "a late action"
                                                                      : "an action";
      std::string text = std::string(source) + (live.asks ? ", a question" : "");
      for (const policy::LiveAnswer& answer : live.answers)
        text += ", the answer to step " + std::to_string(answer.asked);
      return text;
    };
    if (said(here) != said(recorded)) return keep(said(here) + ", recorded " + said(recorded));
    for (std::size_t i = 0; with_delays && i < here.answers.size(); ++i) {
      real("the delay of the answer to step " + std::to_string(here.answers[i].asked),
           here.answers[i].answer_s, recorded.answers[i].answer_s);
    }
  }
  const std::string& first() const { return first_; }

 private:
  void keep(const std::string& text) {
    if (first_.empty()) first_ = text;
  }
  std::string first_;
};

template <typename Record>
bool same_bytes(void (*put)(ByteWriter&, const Record&), const Record& a, const Record& b) {
  ByteWriter x, y;
  put(x, a);
  put(y, b);
  return x.bytes() == y.bytes();
}

std::string named(const std::string& first) { return first.empty() ? "some bits differ" : first; }

}  // namespace

Status TraceComparer::start(const TraceStart& here) {
  if (!recorded_.start) {
    difference_ = "the recorded episode did not get as far as its start";
    return {};
  }
  const TraceStart& recorded = *recorded_.start;
  if (same_bytes(codec::put_start, here, recorded)) return {};
  Finder finder;
  finder.reals("q", here.q, recorded.q, recorded_.header.joints);
  finder.sample(here.sample, recorded.sample, recorded_.header);
  finder.count("bodies at the start", here.starts.size(), recorded.starts.size());
  for (std::size_t i = 0; i < std::min(here.starts.size(), recorded.starts.size()); ++i) {
    const std::string name = " of body " + std::to_string(i);
    finder.vec("start" + name, here.starts[i].position, recorded.starts[i].position);
    finder.vec("half extent" + name, here.starts[i].half, recorded.starts[i].half);
    finder.vec("opening axis" + name, here.starts[i].opening, recorded.starts[i].opening);
  }
  finder.hash("state hash", here.state_hash, recorded.state_hash);
  difference_ = "settled start: " + named(finder.first());
  return {};
}

Status TraceComparer::step(const TraceStep& here) {
  const auto index = static_cast<std::size_t>(steps_++);
  if (!difference_.empty()) return {};
  const std::string where = "step " + std::to_string(steps_) + ": ";
  if (index >= recorded_.steps.size()) {
    difference_ = where + "the recorded episode ended before";
    return {};
  }
  const TraceStep& recorded = recorded_.steps[index];
  const bool is_given = recorded_.header.live && recorded_.header.live->delay_s;
  const bool same_delays = !is_given || here.live == recorded.live;
  if (same_delays && same_bytes(codec::put_step, here, recorded) &&
      same_bytes(codec::put_own, here, recorded))
    return {};
  Finder finder;
  // In the order of cause and effect: what was seen and done, then what came of it.
  finder.hash("prompt hash", here.prompt_hash, recorded.prompt_hash);
  finder.hash("image hash", here.image_hash, recorded.image_hash);
  if (here.live && recorded.live) finder.live(*here.live, *recorded.live, is_given);
  finder.count("live steps", here.live ? 1 : 0, recorded.live ? 1 : 0);
  finder.count("numbers of the action", here.action.size(), recorded.action.size());
  for (std::size_t i = 0; i < std::min(here.action.size(), recorded.action.size()); ++i) {
    finder.real("action " + std::to_string(i), here.action[i], recorded.action[i]);
  }
  finder.reals("q", here.q, recorded.q, recorded_.header.joints);
  finder.reals("u", here.u, recorded.u, recorded_.header.joints);
  finder.sample(here.sample, recorded.sample, recorded_.header);
  std::vector<std::string> metrics;
  for (const auto& metric : recorded_.header.metrics) metrics.push_back(metric.name);
  finder.reals("metric", here.metrics, recorded.metrics, metrics);
  finder.hash("state hash", here.state_hash, recorded.state_hash);
  difference_ = where + named(finder.first());
  return {};
}

Result<Sha256> TraceComparer::finish(const TraceEnd& end) {
  if (difference_.empty() && end.steps != recorded_.steps.size()) {
    difference_ = "ended after step " + std::to_string(end.steps) + ", recorded " +
                  std::to_string(recorded_.steps.size()) +
                  (end.invalid ? " (" + *end.invalid + ")" : std::string());
  }
  if (difference_.empty() && recorded_.end && end.metrics != recorded_.end->metrics) {
    difference_ = "the metrics at the end differ";
  }
  return recorded_.hash;
}

}  // namespace probe::store
