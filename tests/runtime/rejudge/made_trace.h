// A trace of the small plan, made up by hand.
#pragma once

#include <doctest/doctest.h>

#include <string>

#include "runtime/store/trace.h"
#include "tests/runtime/plan/small_plan.h"

namespace probe::rejudge {

inline plan::Plan opened(plan::Writer& w) {
  auto bytes = w.finish();
  REQUIRE_MESSAGE(bytes.ok(), to_text(bytes.failure()));
  auto plan = plan::Plan::from_bytes(std::move(*bytes));
  REQUIRE(plan.ok());
  return std::move(plan).value();
}

inline plan::Plan small() {
  plan::Writer w = plan::small_writer();
  return opened(w);
}

// The carrot comes within 4 cm of the tool at step 3 of 60 and is touched from step 10 on.
inline store::Trace made_trace(const plan::Plan& plan, std::uint32_t task) {
  const plan::TaskRecord& record = plan.tasks()[task];
  store::Trace trace;
  trace.header.task = plan.text(record.name);
  trace.header.prompt = plan.text(record.prompt);
  trace.header.control_hz = 5;
  for (const plan::BodyRecord& body : plan.bodies(record))
    trace.header.bodies.emplace_back(plan.text(body.name));
  const std::size_t bodies = trace.header.bodies.size();
  trace.start.emplace();
  trace.start->starts.resize(bodies);
  trace.start->sample.bodies.resize(bodies);
  trace.start->starts[3].opening = {0, 1, 0};
  for (std::uint32_t i = 1; i <= record.horizon; ++i) {
    store::TraceStep step;
    step.prompt_hash = sha256(trace.header.prompt);
    step.image_hash = sha256("picture " + std::to_string(i));
    step.action = policy::Action::zeros(robot::kActionSize);
    step.sample.bodies.resize(bodies);
    step.sample.step = i;
    step.sample.tcp = {i == 3 ? 0.04 : 0.5 / i + 0.06, 0, 0};
    if (i >= 10) step.sample.contacts = {{0, 3, {0, 0.2, 0}}};
    trace.steps.push_back(step);
  }
  return trace;
}

}  // namespace probe::rejudge
