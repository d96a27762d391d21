// Field by field, in the order TRACE.md gives.
#include "runtime/store/trace_codec.h"

namespace probe::store::codec {
namespace {

constexpr std::size_t kBodyBytes = 16 * sizeof(double);
constexpr std::size_t kOwnBytes = sizeof(std::uint16_t) + 3 * sizeof(double);
constexpr std::size_t kContactBytes = 2 * sizeof(std::uint16_t) + 3 * sizeof(double);

void put_texts(ByteWriter& to, const std::vector<std::string>& texts) {
  to.u32(static_cast<std::uint32_t>(texts.size()));
  for (const std::string& text : texts) to.text(text);
}

std::vector<std::string> get_texts(ByteReader& from) {
  std::vector<std::string> texts(from.count(from.u32(), sizeof(std::uint32_t)));
  for (std::string& text : texts) text = from.text();
  return texts;
}

void put_sample(ByteWriter& to, const vm::StepSample& sample) {
  to.f64(sample.step);
  to.f64(sample.time);
  to.f64(sample.grip);
  to.vec(sample.tcp);
  to.u32(static_cast<std::uint32_t>(sample.bodies.size()));
  for (const vm::BodySample& body : sample.bodies) {
    to.vec(body.position);
    to.vec(body.origin);
    to.vec(body.velocity);
    to.vec(body.spin);
    to.quat(body.rotation);
  }
  to.u32(static_cast<std::uint32_t>(sample.contacts.size()));
  for (const vm::ContactSample& contact : sample.contacts) {
    to.u16(contact.a);
    to.u16(contact.b);
    to.vec(contact.push);
  }
}

// The sample's joints stand in the trace as q and u; at the start nothing moves.
std::vector<vm::JointSample> joints_of(std::span<const double> q, std::span<const double> u) {
  std::vector<vm::JointSample> joints;
  for (std::size_t i = 0; i < q.size(); ++i) joints.push_back({q[i], i < u.size() ? u[i] : 0});
  return joints;
}

vm::StepSample get_sample(ByteReader& from) {
  vm::StepSample sample;
  sample.step = from.f64();
  sample.time = from.f64();
  sample.grip = from.f64();
  sample.tcp = from.vec();
  sample.bodies.resize(from.count(from.u32(), kBodyBytes));
  for (vm::BodySample& body : sample.bodies) {
    body.position = from.vec();
    body.origin = from.vec();
    body.velocity = from.vec();
    body.spin = from.vec();
    body.rotation = from.quat();
  }
  sample.contacts.resize(from.count(from.u32(), kContactBytes));
  for (vm::ContactSample& contact : sample.contacts) {
    contact.a = from.u16();
    contact.b = from.u16();
    contact.push = from.vec();
  }
  return sample;
}

template <typename T>
std::optional<T> whole(const ByteReader& from, T value) {
  if (!from.ok() || from.left() != 0) return std::nullopt;
  return value;
}

}  // namespace

void put_header(ByteWriter& to, const TraceHeader& header) {
  to.hash(header.plan_root);
  to.hash(header.episode_id);
  to.hash(header.start_id);
  to.text(header.task);
  to.u32(static_cast<std::uint32_t>(header.episode));
  to.u32(static_cast<std::uint32_t>(header.seed));
  to.text(header.policy);
  to.text(header.prompt);
  to.u32(header.horizon);
  to.f64(header.control_hz);
  put_texts(to, header.bodies);
  put_texts(to, header.joints);
  to.u32(static_cast<std::uint32_t>(header.metrics.size()));
  for (const TraceHeader::Metric& metric : header.metrics) {
    to.text(metric.name);
    to.u8(metric.is_bool ? 1 : 0);
  }
}

std::optional<TraceHeader> get_header(std::span<const std::byte> bytes) {
  ByteReader from(bytes);
  TraceHeader header;
  header.plan_root = from.hash();
  header.episode_id = from.hash();
  header.start_id = from.hash();
  header.task = from.text();
  header.episode = static_cast<std::int32_t>(from.u32());
  header.seed = static_cast<std::int32_t>(from.u32());
  header.policy = from.text();
  header.prompt = from.text();
  header.horizon = from.u32();
  header.control_hz = from.f64();
  header.bodies = get_texts(from);
  header.joints = get_texts(from);
  header.metrics.resize(from.count(from.u32(), sizeof(std::uint32_t) + 1));
  for (TraceHeader::Metric& metric : header.metrics) {
    metric.name = from.text();
    metric.is_bool = from.u8() != 0;
  }
  return whole(from, std::move(header));
}

void put_actions(ByteWriter& to, const TraceHeader::JointActions& actions) {
  to.text(actions.law);
  to.u32(actions.count);
}

std::optional<TraceHeader::JointActions> get_actions(std::span<const std::byte> bytes) {
  ByteReader from(bytes);
  TraceHeader::JointActions actions;
  actions.law = from.text();
  actions.count = from.u32();
  if (actions.law.empty() || actions.count < 2 || actions.count > robot::kMostActionNumbers)
    return std::nullopt;
  return whole(from, std::move(actions));
}

void put_later(ByteWriter& to, const std::vector<std::string>& later) { put_texts(to, later); }

std::optional<std::vector<std::string>> get_later(std::span<const std::byte> bytes) {
  ByteReader from(bytes);
  std::vector<std::string> later = get_texts(from);
  if (later.empty()) return std::nullopt;
  return whole(from, std::move(later));
}

void put_terms(ByteWriter& to, const policy::LiveTerms& terms) {
  to.u8(terms.delay_s ? 1 : 0);
  to.f64(terms.delay_s.value_or(0));
  to.f64(terms.most_held);
}

std::optional<policy::LiveTerms> get_terms(std::span<const std::byte> bytes) {
  ByteReader from(bytes);
  policy::LiveTerms terms;
  const std::uint8_t is_given = from.u8();
  const double delay_s = from.f64();
  terms.most_held = from.f64();
  if (is_given == 1 && delay_s >= 0) terms.delay_s = delay_s;
  if (is_given > 1 || (is_given == 0 && delay_s != 0) || (is_given == 1 && !terms.delay_s) ||
      !(terms.most_held >= 0 && terms.most_held <= 1)) {
    return std::nullopt;
  }
  return whole(from, terms);
}

void put_start(ByteWriter& to, const TraceStart& start) {
  to.hash(start.state_hash);
  to.reals(start.q);
  to.u32(static_cast<std::uint32_t>(start.starts.size()));
  for (const vm::BodyStart& body : start.starts) {
    to.vec(body.position);
    to.vec(body.half);
    to.vec(body.opening);
  }
  put_sample(to, start.sample);
}

std::optional<TraceStart> get_start(std::span<const std::byte> bytes) {
  ByteReader from(bytes);
  TraceStart start;
  start.state_hash = from.hash();
  start.q = from.reals();
  start.starts.resize(from.count(from.u32(), 9 * sizeof(double)));
  for (vm::BodyStart& body : start.starts) {
    body.position = from.vec();
    body.half = from.vec();
    body.opening = from.vec();
  }
  start.sample = get_sample(from);
  start.sample.joints = joints_of(start.q, {});
  return whole(from, std::move(start));
}

void put_own(ByteWriter& to, const TraceStep& step) {
  to.u32(static_cast<std::uint32_t>(step.sample.own.size()));
  for (const vm::OwnPlace& place : step.sample.own) {
    to.u16(place.body);
    to.vec(place.position);
  }
}

std::optional<std::vector<vm::OwnPlace>> get_own(std::span<const std::byte> bytes) {
  ByteReader from(bytes);
  std::vector<vm::OwnPlace> own(from.count(from.u32(), kOwnBytes));
  for (vm::OwnPlace& place : own) {
    place.body = from.u16();
    place.position = from.vec();
  }
  return whole(from, std::move(own));
}

void put_step(ByteWriter& to, const TraceStep& step) {
  to.hash(step.prompt_hash);
  to.hash(step.image_hash);
  for (const double value : step.action) to.f64(value);
  to.hash(step.state_hash);
  to.reals(step.q);
  to.reals(step.u);
  to.reals(step.metrics);
  put_sample(to, step.sample);
  if (!step.live) return;
  to.u8(static_cast<std::uint8_t>(step.live->source));
  to.u8(step.live->asks ? 1 : 0);
  to.u8(static_cast<std::uint8_t>(step.live->answers.size()));
  for (const policy::LiveAnswer& answer : step.live->answers)
    to.u32(static_cast<std::uint32_t>(answer.asked));
}

std::optional<TraceStep> get_step(std::span<const std::byte> bytes, bool is_live,
                                  std::size_t numbers) {
  ByteReader from(bytes);
  TraceStep step;
  step.prompt_hash = from.hash();
  step.image_hash = from.hash();
  step.action = robot::Action::zeros(numbers);
  for (double& value : step.action) value = from.f64();
  step.state_hash = from.hash();
  step.q = from.reals();
  step.u = from.reals();
  step.metrics = from.reals();
  step.sample = get_sample(from);
  step.sample.joints = joints_of(step.q, step.u);
  if (!is_live) return whole(from, std::move(step));
  policy::LiveStep& live = step.live.emplace();
  const std::uint8_t source = from.u8(), asks = from.u8(), answers = from.u8();
  if (source > static_cast<std::uint8_t>(policy::LiveSource::kHeld) || asks > 1 ||
      answers > policy::kMostAnswersOfAStep)
    return std::nullopt;
  live.source = static_cast<policy::LiveSource>(source);
  live.asks = asks == 1;
  for (int i = 0; i < answers; ++i) {
    policy::LiveAnswer& answer = live.answers.emplace_back();
    answer.asked = static_cast<int>(from.u32());
  }
  return whole(from, std::move(step));
}

void put_end(ByteWriter& to, const TraceEnd& end) {
  to.u32(end.steps);
  to.u32(static_cast<std::uint32_t>(end.metrics.size()));
  for (const MetricValue& metric : end.metrics) {
    to.text(metric.name);
    to.u8(metric.is_bool ? 1 : 0);
    to.f64(metric.value);
  }
  to.u8(end.invalid ? 1 : 0);
  to.text(end.invalid.value_or(""));
}

std::optional<TraceEnd> get_end(std::span<const std::byte> bytes) {
  ByteReader from(bytes);
  TraceEnd end;
  end.steps = from.u32();
  end.metrics.resize(from.count(from.u32(), sizeof(std::uint32_t) + 1 + sizeof(double)));
  for (MetricValue& metric : end.metrics) {
    metric.name = from.text();
    metric.is_bool = from.u8() != 0;
    metric.value = from.f64();
  }
  const bool invalid = from.u8() != 0;
  std::string reason = from.text();
  if (invalid) end.invalid = std::move(reason);
  return whole(from, std::move(end));
}

}  // namespace probe::store::codec
