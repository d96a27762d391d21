// One JSON object a line: an `episode` line, then its `step` lines.
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "runtime/base/json.h"
#include "runtime/export/export.h"

namespace probe::exporting {
namespace {

Json xyz(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Json wxyz(const Quat& q) { return {q.w(), q.x(), q.y(), q.z()}; }

Json metric_json(const store::TraceHeader::Metric& metric, double value) {
  return metric.is_bool ? Json(value != 0) : Json(value);
}

Json sample_json(const vm::StepSample& sample, const std::vector<std::string>& names) {
  Json json;
  json["step"] = sample.step;
  json["time_s"] = sample.time;
  json["grip"] = sample.grip;
  json["tcp_m"] = xyz(sample.tcp);
  Json bodies = Json::object();
  for (std::size_t i = 0; i < sample.bodies.size(); ++i) {
    const vm::BodySample& body = sample.bodies[i];
    bodies[i < names.size() ? names[i] : std::to_string(i)] = {
        {"position_m", xyz(body.position)},
        {"origin_m", xyz(body.origin)},
        {"velocity_m_s", xyz(body.velocity)},
        {"spin_rad_s", xyz(body.spin)},
        {"rotation_wxyz", wxyz(body.rotation)}};
  }
  json["bodies"] = std::move(bodies);
  for (const vm::OwnPlace& place : sample.own) {
    const std::string name =
        place.body < names.size() ? names[place.body] : std::to_string(place.body);
    json["bodies"][name]["own_place_m"] = xyz(place.position);
  }
  Json contacts = Json::array();
  for (const vm::ContactSample& contact : sample.contacts) {
    const auto name = [&](std::uint16_t i) {
      return i < names.size() ? names[i] : std::to_string(i);
    };
    contacts.push_back(
        {{"a", name(contact.a)}, {"b", name(contact.b)}, {"push_Ns", xyz(contact.push)}});
  }
  json["contacts"] = std::move(contacts);
  return json;
}

// Delays in control steps count from the one whose observation was asked with.
Json live_json(int step, const policy::LiveStep& live) {
  Json json;
  json["source"] = to_word(live.source);
  json["asks"] = live.asks;
  json["answers"] = Json::array();
  for (const policy::LiveAnswer& answer : live.answers) {
    json["answers"].push_back({{"asked", answer.asked},
                               {"delay_steps", step - answer.asked},
                               {"delay_s", answer.answer_s}});
  }
  return json;
}

Json terms_json(const policy::LiveTerms& terms) {
  return {{"delay_s", terms.delay_s ? Json(*terms.delay_s) : Json(nullptr)},
          {"most_held", terms.most_held}};
}

Json episode_json(const store::ResultRow& row, const store::Trace& trace) {
  const store::TraceHeader& header = trace.header;
  Json json;
  json["kind"] = "episode";
  json["task"] = header.task;
  json["episode"] = header.episode;
  json["seed"] = header.seed;
  json["policy"] = header.policy;
  json["prompt"] = header.prompt;
  if (!header.later.empty()) json["then"] = header.later;
  json["plan_root"] = to_hex(header.plan_root);
  json["episode_id"] = to_hex(header.episode_id);
  json["start_id"] = to_hex(header.start_id);
  json["trace_sha256"] = row.trace_sha256;
  json["horizon"] = header.horizon;
  json["control_hz"] = header.control_hz;
  json["steps"] = trace.steps.size();
  json["invalid"] = row.invalid ? Json(*row.invalid) : Json(nullptr);
  json["live"] = header.live ? terms_json(*header.live) : Json(nullptr);
  if (header.joint_actions) json["action_law"] = header.joint_actions->law;
  json["idle"] = row.idle;
  json["delay"] = row.delay;
  json["bodies"] = header.bodies;
  json["joints"] = header.joints;
  Json metrics = Json::object();
  for (const store::MetricValue& metric : row.metrics) {
    metrics[metric.name] =
        row.invalid ? Json(nullptr) : metric_json({metric.name, metric.is_bool}, metric.value);
  }
  json["metrics"] = std::move(metrics);
  json["fixture_joints"] = Json::object();
  for (const store::JointValue& joint : row.joints)
    json["fixture_joints"][joint.name] = joint.position;
  json["start"] = nullptr;
  if (trace.start) {
    Json start;
    start["q"] = trace.start->q;
    Json bodies = Json::object();
    for (std::size_t i = 0; i < trace.start->starts.size() && i < header.bodies.size(); ++i) {
      const vm::BodyStart& body = trace.start->starts[i];
      bodies[header.bodies[i]] = {{"position_m", xyz(body.position)},
                                  {"half_m", xyz(body.half)},
                                  {"opening", xyz(body.opening)}};
    }
    start["bodies"] = std::move(bodies);
    start["sample"] = sample_json(trace.start->sample, header.bodies);
    json["start"] = std::move(start);
  }
  return json;
}

Json step_json(const store::TraceHeader& header, const store::TraceStep& step, int number) {
  Json json;
  json["kind"] = "step";
  json["task"] = header.task;
  json["episode"] = header.episode;
  json["seed"] = header.seed;
  json.update(sample_json(step.sample, header.bodies));
  json["action"] = std::vector<double>(step.action.begin(), step.action.end());
  json["live"] = step.live ? live_json(number, *step.live) : Json(nullptr);
  json["q"] = step.q;
  json["u"] = step.u;
  Json metrics = Json::object();
  for (std::size_t i = 0; i < step.metrics.size() && i < header.metrics.size(); ++i)
    metrics[header.metrics[i].name] = metric_json(header.metrics[i], step.metrics[i]);
  json["metrics"] = std::move(metrics);
  json["prompt_sha256"] = to_hex(step.prompt_hash);
  json["image_sha256"] = to_hex(step.image_hash);
  json["state_hash"] = to_hex(step.state_hash);
  json["render_s"] = step.render_s;
  json["policy_s"] = step.policy_s;
  json["physics_s"] = step.physics_s;
  return json;
}

class JsonLines final : public Sink {
 public:
  JsonLines(std::FILE* file, std::string path) : file_(file), path_(std::move(path)) {}
  ~JsonLines() override {
    if (file_ != nullptr) std::fclose(file_);
  }
  JsonLines(const JsonLines&) = delete;
  JsonLines& operator=(const JsonLines&) = delete;

  Status episode(const store::ResultRow& row, const store::Trace& trace) override {
    PROBE_TRY(line(episode_json(row, trace)));
    int number = 0;  // of steps done before
    for (const store::TraceStep& step : trace.steps)
      PROBE_TRY(line(step_json(trace.header, step, number++)));
    return {};
  }

  Status finish() override {
    std::FILE* const file = std::exchange(file_, nullptr);
    return std::fclose(file) == 0 ? Status() : failed();
  }

 private:
  Failure failed() const {
    return {Fault::kIo, std::string("cannot be written: ") + std::strerror(errno), path_};
  }
  Status line(const Json& json) {
    // What is not UTF-8 in a recorded text is replaced, never thrown.
    const std::string text = json.dump() + "\n";
    if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) return failed();
    return {};
  }

  std::FILE* file_;
  std::string path_;
};

}  // namespace

Result<std::unique_ptr<Sink>> open_json_lines(const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr)
    return Failure{Fault::kIo, std::string("cannot be made: ") + std::strerror(errno), path};
  return std::unique_ptr<Sink>(std::make_unique<JsonLines>(file, path));
}

}  // namespace probe::exporting
