// A small made-up trace for tests that need no world.
#pragma once

#include <string>

#include "runtime/store/trace.h"

namespace probe::store {

inline TraceHeader sample_header() {
  TraceHeader header;
  header.plan_root = sha256(std::string_view("plan"));
  header.episode_id = sha256(std::string_view("episode"));
  header.start_id = sha256(std::string_view("start"));
  header.task = "carrot_on_plate";
  header.episode = 3;
  header.seed = 42;
  header.policy = "null";
  header.prompt = "put carrot on plate";
  header.horizon = 5;
  header.control_hz = 5;
  header.bodies = {"carrot", "plate"};
  header.joints = {"waist", "left_finger"};
  header.metrics = {{"success", true}, {"height", false}};
  header.fingerprint = R"({"cpu":"test"})";
  return header;
}

inline vm::StepSample sample_measurements(int step) {
  vm::StepSample sample;
  sample.step = step;
  sample.time = 0.2 * step;
  sample.grip = 0.25;
  sample.tcp = {0.1, -0.0, 1.0 / 3};
  sample.bodies.resize(2);
  sample.bodies[0].position = {0.01 * step, 2, 3};
  sample.bodies[1].rotation = Quat(0.5, 0.5, 0.5, 0.5);
  sample.contacts = {{0, 1, {0, 0, -1e-3 * step}}};
  return sample;
}

inline TraceStart sample_start() {
  TraceStart start;
  start.q = {0.5, 0.037};
  start.starts.resize(2);
  start.starts[1].half = {0.05, 0.05, 0.01};
  start.sample = sample_measurements(0);
  start.state_hash = sha256(std::string_view("settled"));
  return start;
}

inline TraceStep sample_step(int number) {
  TraceStep step;
  step.prompt_hash = sha256(std::string_view("put carrot on plate"));
  step.image_hash = sha256("picture " + std::to_string(number));
  step.action = {0.01, 0, 0, 0, 0, 0.1 * number, 1};
  step.q = {0.5 + number, 0.037};
  step.u = {0.1, 0};
  step.sample = sample_measurements(number);
  step.metrics = {number > 2 ? 1.0 : 0.0, 0.125 * number};
  step.state_hash = sha256("state " + std::to_string(number));
  step.render_s = 0.006;
  return step;
}

// Writes `steps` of them; returns the trace's hash.
inline Result<Sha256> write_sample_trace(const std::string& path, int steps,
                                         double render_s = 0.006,
                                         const TraceHeader& header = sample_header()) {
  PROBE_ASSIGN(auto writer, TraceWriter::create(path, header));
  PROBE_TRY(writer->start(sample_start()));
  for (int i = 1; i <= steps; ++i) {
    TraceStep step = sample_step(i);
    step.render_s = render_s;
    PROBE_TRY(writer->step(step));
  }
  return writer->finish({static_cast<std::uint32_t>(steps),
                         {{"success", true, 1}, {"height", false, 0.125 * steps}},
                         std::nullopt});
}

}  // namespace probe::store
