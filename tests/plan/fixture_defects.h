// One defect a rule of fixtures with joints, made on the plan of fixture_plan.h.
#pragma once

#include "tests/plan/defects.h"
#include "tests/runtime/plan/fixture_plan.h"

namespace probe::plan {

inline std::vector<Defect> fixture_defects() {
  return {
      {"FJNT", "turns (1) or slides (2), not 7",
       [](Records& r, Writer&) { r.fixture_joints[0].motion = 7; }},
      {"FJNT", "lies below the upper", [](Records& r, Writer&) { r.fixture_joints[0].lower = 1; }},
      {"FJNT", "begins at 0.5, its limits are 0 and 0.2",
       [](Records& r, Writer&) { r.fixture_joints[0].start = 0.5; }},
      {"FJNT", "finite and not negative",
       [](Records& r, Writer&) { r.fixture_joints[0].damping = -1; }},
      {"FIXT", "an armature for each of its 2 joints",
       [](Records& r, Writer& w) { r.fixtures[0].armatures = w.reals(std::vector<double>{0.1}); }},
      {"REAL", "an armature",
       [](Records& r, Writer& w) {
         r.fixtures[0].armatures = w.reals(std::vector<double>{0.1, -1});
       }},
      {"FIXT", "its joints begin at record 0",
       [](Records& r, Writer&) {
         r.fixtures[0].joints = {1, 1};
       }},
      {"PART", "a part belongs to a fixture",
       [](Records& r, Writer& w) {
         r.parts.push_back(r.parts[1]);
         r.parts.back().name = w.text("other");
       }},
      {"LIST", "stands twice",
       [](Records& r, Writer& w) {
         r.scenes[0].fixtures = w.list(std::vector<std::uint32_t>{0, 0});
       }},
      {"PART", "two parts are called",
       [](Records& r, Writer&) { r.parts[1].name = r.parts[0].name; }},
      {"SHOW", "above (1) or below (2), not 3",
       [](Records& r, Writer& w) {
         r.shown = {{w.text("glow"), 1, 3, 0.5}};
         r.fixtures[0].shown = {0, 1};
       }},
      {"SHOW", "FJNT",
       [](Records& r, Writer& w) {
         r.shown = {{w.text("glow"), 2, 1, 0.5}};
         r.fixtures[0].shown = {0, 1};
       }},
      {"SHOW", "link `glow` is shown twice",
       [](Records& r, Writer& w) {
         r.shown = {{w.text("glow"), 1, 1, 0.5}, {w.text("glow"), 0, 1, 0.1}};
         r.fixtures[0].shown = {0, 2};
       }},
      {"SHOW", "what is shown belongs to a fixture",
       [](Records& r, Writer& w) {
         r.shown = {{w.text("glow"), 1, 1, 0.5}};
       }},
      {"PART", "FJNT", [](Records& r, Writer&) { r.parts[1].joint = 2; }},
      {"REGN", "not 4", [](Records& r, Writer&) { r.regions[0].kind = 4; }},
      {"REGN", "PART", [](Records& r, Writer&) { r.regions[0].index = 9; }},
      {"REGN", "positive extent", [](Records& r, Writer&) { r.regions[0].high[2] = 0; }},
      {"EPIS", "begins with 1 joints",
       [](Records& r, Writer& w) { r.episodes[0].joints = w.reals(std::vector<double>{0}); }},
      {"EPIS", "`top` begins at 0.5",
       [](Records& r, Writer& w) {
         r.episodes[0].joints = w.reals(std::vector<double>{0.5, 0});
       }},
      {"BODY", "is part 0, wanted is 1", [](Records& r, Writer&) { r.bodies[7].index = 0; }},
      {"TASK", "role `helper` of task `carrot_on_plate` has no part or region of its scene",
       [](Records& r, Writer& w) {
         r.roles = {{w.text("helper"), 4, 2, 1, 0, 0}};
         r.tasks[0].roles = {0, 1};
       }},
      {"TASK", "role `target` of task `carrot_on_plate` is filled with an object, too",
       [](Records& r, Writer& w) {
         r.roles = {{w.text("target"), 4, kDrawerBody, 1, 0, 0}};
         r.tasks[0].roles = {0, 1};
       }},
      {"TASK", "two roles of task `carrot_on_plate` have one name",
       [](Records& r, Writer& w) {
         r.roles = {{w.text("drawers"), 6, kDrawerBody, 1, 0, 0},
                    {w.text("helper"), 4, kDrawerBody, 1, 0, 0},
                    {w.text("drawers"), 6, kDrawerBody, 1, 0, 0}};
         r.tasks[0].roles = {0, 3};
       }},
      {"TASK", "is listed twice",
       [](Records& r, Writer& w) {
         r.roles = {{w.text("drawers"), 6, kDrawerBody, 1, 0, 0}, {{}, 7, kDrawerBody, 1, 0, 0}};
         r.tasks[0].roles = {0, 2};
       }},
      {"ROLE", "a role has a name of its own",
       [](Records& r, Writer& w) {
         r.roles = {{w.text("drawers"), 7, kDrawerBody, 1, 0, 0}};
         r.tasks[0].roles = {0, 1};
       }},
      {"ROLE", "a role has a name of its own",
       [](Records& r, Writer& w) {
         r.roles = {{w.text("target"), 6, kDrawerBody, 1, 0, 0}};
         r.tasks[0].roles = {0, 1};
       }},
      {"TASK", "stands behind one of a part or region",
       [](Records& r, Writer& w) {
         r.roles = {{w.text("place"), 5, 0, 1, 0, 0}, {w.text("helper"), 1, 2, 1, 0, 0}};
         r.tasks[0].roles = {0, 2};
       }},
      {"CODE", "names joint 5", [](Records& r, Writer&) { r.code[18].a = 5; }},
      {"CODE", "which turns", [](Records& r, Writer&) { r.code[18].a = 1; }},
  };
}

}  // namespace probe::plan
