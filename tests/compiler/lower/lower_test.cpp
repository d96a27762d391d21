#include "compiler/lower/lower.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "compiler/define/views.h"
#include "compiler/lower/builder.h"
#include "tests/compiler/small_suite.h"

using namespace probe;

namespace {

sema::Frame frame_of(const test::Analysis& a, const sema::Task& task) {
  return sema::frame_of(a.model, a.model.scenes[task.scene],
                        a.model.cameras[sema::views_of(a.model, task).front().camera]);
}

struct Lowered {
  std::string text;  // the disassembly, with a line break before it
  std::string codes;
  std::string said;
};

Lowered lowered(const std::string& metrics, const std::string& task = "",
                const std::string& more = "") {
  const auto a =
      test::analyze_with_suite(more + "\nmetrics m like plain { " + metrics +
                               " }\ntask t like red_on_tray { metrics m; " + task + " }");
  sema::Task t = a->task("t");
  // The tests look at the other metrics alone.
  if (!t.judged.empty()) t.judged.erase(t.judged.begin());
  Lowered result;
  if (t.complete && !a->diagnostics.has_errors()) {
    const auto bodies = lower::bodies_of(a->model, t);
    std::vector<std::string> names;
    for (const lower::Body& body : bodies) names.push_back(body.name);
    const auto program =
        lower::lower_metrics(a->model, t.judged, bodies, frame_of(*a, t), a->diagnostics);
    if (program) result.text = "\n" + lower::to_text(*program, names);
  }
  result.codes = a->codes();
  result.said = a->said();
  return result;
}

}  // namespace

TEST_CASE(
    "bodies stand in the plan's order: objects, surface, fingers, other links with collision") {
  const auto a = test::analyze_with_suite("variant v of red_on_tray { distractors blue }");
  std::string names;
  for (const lower::Body& body : lower::bodies_of(a->model, a->task("v"))) names += body.name + " ";
  CHECK(names == "red tray blue surface left right base wrist ");
}

TEST_CASE("`fingers` are all of a hand and nothing else, whether it has one or three") {
  for (const std::size_t count : {std::size_t{1}, std::size_t{3}}) {
    auto a = test::analyze_with_suite(
        "metrics touched { success = at end any f in fingers: impulse(f, source) > 1e-6Ns }\n"
        "variant v of red_on_tray { metrics touched }");
    const sema::Task& task = a->task("v");
    sema::Robot& robot = a->model.robots[a->model.scenes[task.scene].robot];
    robot.fingers.resize(count, robot.fingers.front());
    if (count == 3) robot.fingers.back().link.text = "wrist";
    Diagnostics unheard;
    const auto program =
        lower::lower_metrics(a->model, task.judged, lower::bodies_of(a->model, task), {}, unheard);
    REQUIRE(program);
    const auto is_touch = [](const plan::Instruction& in) {
      return in.op == static_cast<std::uint8_t>(plan::Op::kIMP);
    };
    CHECK(std::ranges::count_if(program->code, is_touch) == static_cast<std::ptrdiff_t>(count));
  }
}

TEST_CASE("a greater-than swaps its sides and equal subexpressions are shared") {
  const Lowered code = lowered(
      "x = at end (height(source) > height(target) and height(source) - height(target) <= 2cm)");
  CHECK_MESSAGE(code.text == R"(
   0  POS    r0    red
   1  VZ     r1    r0
   2  POS    r2    tray
   3  VZ     r3    r2
   4  LT     r4    r3 r1
   5  SUB    r5    r1 r3
   6  KR     r6    0.02
   7  LE     r7    r5 r6
   8  AND    r8    r4 r7
   9  EMITB        r8 -> x
  10  END
)",
                (code.text + code.said));
}

TEST_CASE("quantifiers unroll over the bodies of the task and fold where the set is empty") {
  const Lowered two = lowered("x = at end (any f in fingers: impulse(f, source) > 1e-6Ns)");
  CHECK_MESSAGE(two.text == R"(
   0  IMP    r0    red left
   1  KR     r1    1e-06
   2  LT     r2    r1 r0
   3  IMP    r3    red right
   4  LT     r4    r1 r3
   5  OR     r5    r2 r4
   6  EMITB        r5 -> x
   7  END
)",
                (two.text + two.said));
  CHECK(lowered("x = at end (all o in distractors: moved_xy(o) < 1cm)").text == R"(
   0  KB     r0    1
   1  EMITB        r0 -> x
   2  END
)");
  CHECK(
      lowered("x = at end (no b in bodies - {source, target} - links: impulse(source, b) > 1e-6Ns)",
              "distractors blue")
          .text == R"(
   0  IMP    r0    red blue
   1  KR     r1    1e-06
   2  LT     r2    r1 r0
   3  IMP    r3    red surface
   4  LT     r4    r1 r3
   5  OR     r5    r2 r4
   6  NOT    r6    r5
   7  EMITB        r6 -> x
   8  END
)");
}

TEST_CASE("sets join, meet and differ") {
  const auto count = [](const char* set) {
    const std::string text =
        lowered(std::string("x = at end (any b in ") + set + ": impulse(target, b) > 1e-6Ns)",
                "distractors blue")
            .text;
    std::size_t n = 0;
    for (std::size_t at = text.find("IMP"); at != std::string::npos; at = text.find("IMP", at + 1))
      ++n;
    return n;
  };
  CHECK(count("{source}") == 1);
  CHECK(count("{source, source}") == 1);
  CHECK(count("others - {target}") == 1);
  CHECK(count("links") == 4);
  CHECK(count("links - fingers | {surface}") == 3);
  CHECK(count("objects & others - {target}") == 1);
  CHECK(count("bodies - objects") == 5);
}

TEST_CASE("an angle becomes a cosine, exact for whole degrees") {
  const Lowered code = lowered("x = once (angle(axis_z(source), up()) <= 60deg)");
  CHECK_MESSAGE(code.text == R"(
   0  AXIS   r0    red 2
   1  KV     r1    (0, 0, 1)
   2  VLEN   r2    r0
   3  VLEN   r3    r1
   4  KR     r4    0.5
   5  MUL    r5    r4 r2
   6  MUL    r6    r5 r3
   7  VDOT   r7    r0 r1
   8  LE     r8    r6 r7
   9  ONCE   r9    r8 s0
  10  EMITB        r9 -> x
  11  END
)",
                (code.text + code.said));
  // The wider side swaps the comparison.
  CHECK(
      lowered("x = at end (angle(axis_z(source), up()) > 90deg)").text.find("LT     r8    r7 r6") !=
      std::string::npos);
}

TEST_CASE("monitors keep one state each and equal ones are shared") {
  const Lowered code = lowered(
      "a = once (step > 3 for 5 steps); b = count (step > 3 for 5 steps); c = max height(source); "
      "d = final grip");
  CHECK_MESSAGE(code.text == R"(
   0  STEP   r0
   1  KR     r1    3
   2  LT     r2    r1 r0
   3  HOLD   r3    r2 s0(5)
   4  ONCE   r4    r3 s1
   5  EMITB        r4 -> a
   6  COUNT  r5    r3 s2
   7  EMITR        r5 -> b
   8  POS    r6    red
   9  VZ     r7    r6
  10  MAXR   r8    r7 s3
  11  EMITR        r8 -> c
  12  GRIP   r9
  13  EMITR        r9 -> d
  14  END
)",
                (code.text + code.said));
}

TEST_CASE(
    "constants fold in the order of the text and predicates are inlined with their defaults") {
  const Lowered code =
      lowered("x = at end high(source, extra: 1cm + 2cm)", "",
              "predicate high(o: object, limit: length = 10cm, extra: length = 0cm) "
              "= height(o) > limit + extra");
  CHECK_MESSAGE(code.text.find("0.13") != std::string::npos, (code.text + code.said));
  CHECK(code.text.find("ADD") == std::string::npos);
}

TEST_CASE("what the judge cannot do is reported once, where it stands") {
  const Lowered division = lowered("x = at end (height(source) / height(target) < 2)");
  CHECK(division.codes == "P0601");
  CHECK(division.said.find("no division") != std::string::npos);
  CHECK(lowered("x = at end (angle(opening(f: surface), up()) < 60deg)").codes == "P0601");
  CHECK(lowered("x = at end (any b in links: angle(opening(b), up()) < 60deg)").codes == "P0601");
  CHECK(lowered("x = at end angles(source, 1deg * step)", "",
                "predicate angles(o: object, limit: angle) = angle(axis_z(o), up()) <= limit")
            .codes == "P0601");
}

TEST_CASE("a program that does not fit is refused, however large it would be") {
  const Lowered code = lowered(
      "x = once (any a in bodies: any b in bodies: any c in bodies: any d in bodies: any e in "
      "bodies: "
      "impulse(a, b) + impulse(c, d) > impulse(d, e))");
  CHECK(code.codes == "P0601");
  CHECK(code.said.find("4096") != std::string::npos);
}

TEST_CASE("the builder tells zero from minus zero and shares vectors") {
  lower::Builder builder;
  CHECK(builder.constant(0.0) != builder.constant(-0.0));
  CHECK(builder.vector(0, 0, 1) == builder.vector(0, 0, 1));
  CHECK(builder.finish().constants.size() == 5);
}

TEST_CASE(
    "coordinates are the world's, the picture's or the robot's, and a vector is three constants") {
  CHECK(lowered("ahead = final x(source); off = final distance(target, (10cm, -2cm, 1m))").text ==
        R"(
   0  POS    r0    red
   1  VX     r1    r0
   2  EMITR        r1 -> ahead
   3  KV     r2    (0.1, -0.02, 1)
   4  POS    r3    tray
   5  VSUB   r4    r3 r2
   6  VLEN   r5    r4
   7  EMITR        r5 -> off
   8  END
)");
  // The robot stands at (50cm, 0cm) and is turned by 180deg.
  CHECK(lowered("ahead = final robot_x(source); left = final robot_y(source)").text == R"(
   0  KV     r0    (0.5, 0, 0.8)
   1  POS    r1    red
   2  VSUB   r2    r1 r0
   3  KV     r3    (-1, 0, 0)
   4  VDOT   r4    r2 r3
   5  EMITR        r4 -> ahead
   6  KV     r5    (0, -1, 0)
   7  VDOT   r6    r2 r5
   8  EMITR        r6 -> left
   9  END
)");
  // A metre above it the camera looks down along the robot's x: right in the picture is the world's
  // y.
  CHECK(lowered("right = final view_x(source)").text == R"(
   0  KV     r0    (0.5, 0, 1.8)
   1  POS    r1    red
   2  VSUB   r2    r1 r0
   3  KV     r3    (0, 1.0606601717798214, 0)
   4  VDOT   r4    r2 r3
   5  KV     r5    (-0.70710678118654746, 0, -0.70710678118654757)
   6  VDOT   r6    r2 r5
   7  RATIO  r7    r4 r6
   8  EMITR        r7 -> right
   9  END
)");
}

TEST_CASE("what has no place in the picture and what is no vector is said at its place") {
  const auto said = [](const std::string& metrics, const std::string& task = "",
                       const std::string& more = "") {
    const std::string text = lowered("m = at end " + metrics, task, more).said;
    return text.substr(0, text.find('\n'));
  };
  CHECK(said("view_x(source) > 1cm", "camera on_wrist",
             "camera on_wrist like eye { mount arm.wrist at (0cm, 0cm, 1m) look (1, 0, -1) }") ==
        "error[P0601]: `view_x` needs a first camera that stands still and sees the area");
  CHECK(
      said("view_x(source) > 1cm", "camera shaken", "camera shaken like eye { jitter 3cm 5deg }") ==
      "error[P0601]: `view_x` needs a first camera that stands in one place; this one has "
      "`jitter` and stands elsewhere in each start");
  CHECK(said("distance(source, (x(target), 0cm, 0cm)) < 1cm") ==
        "error[P0601]: the numbers of a vector are constants, this is measured");
  CHECK(said("distance(source, (1cm, 0, 0cm)) < 1cm") ==
        "error[P0302]: expected a length, found a number");
  CHECK(said("angle(axis_z(source), (0, 0, source)) < 10deg") ==
        "error[P0601]: expected a number, found an object");
}

TEST_CASE(
    "tasks of one shape have one program, and another metric or another body is another shape") {
  const auto a = test::analyze_with_suite(R"(
metrics other like plain { success = at end (height(source) > 2 * height(target)) }
variant turned of red_on_tray { source tray; target red }
variant crowded of red_on_tray { distractors blue }
variant judged of red_on_tray { metrics other }
variant longer of red_on_tray { horizon 70 steps })");
  const auto shape = [&](const char* name) {
    const sema::Task& task = a->task(name);
    return lower::shape_of(a->model, task.judged, lower::bodies_of(a->model, task));
  };
  const auto code = [&](const char* name) {
    const sema::Task& task = a->task(name);
    return *lower::lower_metrics(a->model, task.judged, lower::bodies_of(a->model, task),
                                 frame_of(*a, task), a->diagnostics);
  };
  for (const char* same : {"turned", "longer"}) {
    CAPTURE(same);
    CHECK(shape(same) == shape("red_on_tray"));
    CHECK(code(same).same_as(code("red_on_tray")));
  }
  CHECK(shape("crowded") != shape("red_on_tray"));
  CHECK(shape("judged") != shape("red_on_tray"));
}

TEST_CASE("joints are measured from where they are closed, regions in the frame of their owner") {
  const auto in_room = [](const std::string& metrics) {
    return lowered(metrics, "scene room", test::kChest);
  };
  CHECK_MESSAGE(in_room("x = final travel(chest.drawer)").text == R"(
   0  SLIDE  r0    j0
   1  EMITR        r0 -> x
   2  END
)",
                in_room("x = final travel(chest.drawer)").said);
  // Its upper limit is 0: it opens downwards.
  CHECK(in_room("x = at end turn(chest.door) > 0.5 * range(chest.door)").text == R"(
   0  TURN   r0    j1
   1  NEG    r1    r0
   2  KR     r2    0.75
   3  LT     r3    r2 r1
   4  EMITB        r3 -> x
   5  END
)");
  CHECK(in_room("x = max rate(chest.hinge)").text == R"(
   0  TURNING r0    j1
   1  NEG    r1    r0
   2  MAXR   r2    r1 s0
   3  EMITR        r2 -> x
   4  END
)");
  CHECK(in_room("x = at end within(source, chest.inside)").text == R"(
   0  POS    r0    red
   1  LOCAL  r1    chest.drawer r0
   2  VX     r2    r1
   3  KR     r3    -0.04
   4  LE     r4    r3 r2
   5  KR     r5    0.04
   6  LE     r6    r2 r5
   7  AND    r7    r4 r6
   8  VY     r8    r1
   9  LE     r9    r3 r8
  10  LE     r10   r8 r5
  11  AND    r11   r9 r10
  12  AND    r12   r7 r11
  13  VZ     r13   r1
  14  LE     r14   r3 r13
  15  LE     r15   r13 r5
  16  AND    r16   r14 r15
  17  AND    r17   r12 r16
  18  EMITB        r17 -> x
  19  END
)");
}

TEST_CASE("what a task's scene does not have is not measured") {
  const auto refused = [](const std::string& metrics, const std::string& task = "scene room") {
    return lowered(metrics, task, test::kChest).codes;
  };
  CHECK(refused("x = final travel(chest.drawer)", "") == "P0201");
  CHECK(refused("x = at end slide(chest.door) > 1cm") == "P0601");
  CHECK(refused("x = at end turn(chest.drawer) > 1deg") == "P0601");
  CHECK(refused("x = at end within(source, target.inside)") == "P0201");
  CHECK(refused("x = at end within(source, surface.left)") == "P0201");
  CHECK(refused("x = at end within(source, fixture.basin)") == "P0601");
  CHECK(refused("x = final range(chest.ring)") == "P0601");
}

TEST_CASE("regions are those of what stands there") {
  const std::string more =
      std::string(test::kChest) +
      "object dish like tray { name \"dish\"; region well box (-2cm, -2cm, 0cm) .. "
      "(2cm, 2cm, 3cm) }\n"
      "scene marked like room { region left of surface box (0cm, 0cm, 0cm) .. "
      "(9cm, 9cm, 9cm) }";
  const Lowered code = lowered(
      "x = at end within(source, target.well)\n"
      "y = at end within(source, surface.left)",
      "scene marked; target dish", more);
  CHECK_MESSAGE(code.text.find("LOCAL  r1    dish r0") != std::string::npos,
                (code.text + code.said));
  CHECK(code.text.find("surface r0") != std::string::npos);
}

TEST_CASE("a predicate of a part that follows another names the joint to measure") {
  const auto sliding = [](const std::string& name, const std::string& more) {
    return "<link name=\"" + name +
           "\"><inertial><mass value=\"1\"/><inertia ixx=\"0.1\" iyy=\"0.1\" izz=\"0.1\" ixy=\"0\" "
           "ixz=\"0\" iyz=\"0\"/></inertial><collision><geometry><box size=\"0.1 0.1 0.1\"/>"
           "</geometry></collision></link><joint name=\"to_" +
           name + "\" type=\"prismatic\"><parent link=\"body\"/><child link=\"" + name +
           "\"/><axis xyz=\"1 0 0\"/><limit lower=\"0\" upper=\"0.1\" effort=\"1\" "
           "velocity=\"1\"/>" +
           more + "</joint>";
  };
  test::write_text(std::filesystem::path(test::asset_root()) / "pair/pair.urdf",
                   "<robot name=\"pair\"><link name=\"body\"/>" + sliding("lead", "") +
                       sliding("other", "<mimic joint=\"to_lead\"/>") + "</robot>");
  const auto moved = [](const std::string& part) {
    return lowered("x = at end moved(pair." + part + ")", "scene room",
                   "fixture pair { urdf \"pair/pair.urdf\"; at (0cm, 30cm, 185cm); part first link "
                   "lead; part second link other }\nscene room like bench { fixture pair }\n"
                   "predicate moved(p: part) = slide(p) > 4cm\n");
  };
  CHECK_MESSAGE(moved("first").codes.empty(), moved("first").said);
  CHECK(moved("second").codes == "P0601");
  CHECK_MESSAGE(
      moved("second").said.find("`pair.second` follows `pair.to_lead` and has no travel of "
                                "its own: measure `pair.to_lead`") != std::string::npos,
      moved("second").said);
}
