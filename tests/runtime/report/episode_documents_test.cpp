#include "runtime/report/episode_documents.h"
#include "runtime/base/json.h"

#include <doctest/doctest.h>

using namespace probe;
using namespace probe::report;

namespace {

store::Trace small_trace() {
  store::Trace trace;
  trace.header.bodies = {"cup", "plate", "surface", "left_finger"};
  trace.header.metrics = {{"success", true}, {"first", false}, {"grasp", true}};
  for (int step = 1; step <= 5; ++step) {
    store::TraceStep record;
    record.sample.bodies.resize(4);
    record.sample.bodies[0].position = Vec3(0.01 * step, 0, 0);
    record.sample.grip = step >= 3 ? 0.9 : 0.1;
    record.sample.contacts = {{.a = 0, .b = 2, .push = Vec3::Zero()}};
    if (step == 2 || step == 4 || step == 5)
      record.sample.contacts.push_back({.a = 0, .b = 3, .push = Vec3::Zero()});
    record.metrics = {step == 5 ? 1.0 : 0.0, 7.0, step >= 3 ? 1.0 : 0.0};
    trace.steps.push_back(record);
  }
  return trace;
}

}  // namespace

TEST_CASE("a timeline has spans of truths, gripper and contacts, and distances") {
  const std::vector<std::string> metrics = {"grasp", "success", "first"};
  CHECK(encode_timeline(small_trace(), metrics) ==
        "m1:5-5;m0:3-5;g:3-5;c0.3:2-2,4-5;d:1.0,3.0,5.0");
}

TEST_CASE("metrics that the page does not know are left out of a timeline") {
  CHECK(encode_timeline(small_trace(), {}) == "g:3-5;c0.3:2-2,4-5;d:1.0,3.0,5.0");
  CHECK(encode_timeline(store::Trace{}, {}).empty());
}

TEST_CASE("a timeline has the joints of fixtures that moved, in centimetres and degrees") {
  store::Trace trace = small_trace();
  trace.header.joints = {"waist", "cabinet.top", "cabinet.middle", "door.hinge"};
  for (std::size_t i = 0; i < trace.steps.size(); ++i) {
    const double on = static_cast<double>(i);
    trace.steps[i].sample.joints = {{on, 0}, {0.02 * on, 0}, {0.03, 0}, {-0.1 * on, 0}};
  }
  const std::vector<TimelineJoint> joints = {{"cabinet.top", true, 0, 0.14},
                                             {"cabinet.middle", true, 0, 0.14},
                                             {"door.hinge", false, -1.5, 0}};
  const std::string text = encode_timeline(trace, {}, {}, joints);
  CHECK(text == "g:3-5;c0.3:2-2,4-5;d:1.0,3.0,5.0;j0:0.0,4.0,8.0;j2:0.0,-11.5,-22.9");
}

TEST_CASE("an episode whose trace is gone has no timeline, and a note says so") {
  store::ResultRow row;
  row.task = "t";
  row.trace = "/nowhere/t/0-42.trace";
  const std::vector<EpisodeTrace> episodes(8, EpisodeTrace{&row, nullptr, 0});
  const auto documents = episode_documents(episodes, {}, 1, {.jobs = 2});
  const auto timelines = Json::parse(documents.timelines);
  CHECK(timelines["e"] == Json::parse("[0,0,0,0,0,0,0,0]"));
  CHECK(timelines["bodies"].size() == 1);
  REQUIRE(documents.notes.size() == 6);
  CHECK(documents.notes[0].find("/nowhere/t/0-42.trace") != std::string::npos);
  CHECK(documents.notes[5] == "3 further episodes without a timeline");
}

TEST_CASE("without traces both documents are empty objects") {
  const auto documents = episode_documents({}, {}, 0, {});
  CHECK(documents.timelines == "{}");
  CHECK(documents.whys == "{}");
}
