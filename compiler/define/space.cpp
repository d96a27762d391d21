// `space`: what may vary about a task. Its ends are read here; which points between them are fair
// is found point by point, by compiling each (compiler/space).
#include <algorithm>
#include <cmath>
#include <numbers>

#include "compiler/define/axes.h"
#include "compiler/define/define.h"
#include "compiler/define/role.h"
#include "compiler/define/template.h"
#include "compiler/define/thing.h"
#include "compiler/define/views.h"
#include "compiler/names/quantities.h"
#include "runtime/base/utf8.h"
#include "runtime/plan/limits.h"

namespace probe::sema {
namespace {

std::string number_text(double value) {
  std::string text = std::to_string(value);
  while (text.ends_with('0')) text.pop_back();
  if (text.ends_with('.')) text.pop_back();
  return text;
}

struct SpaceReader {
  Context& context;
  Space& space;
  const Task& task;
  std::vector<View> views;

  void add(SpaceAxis axis) {
    // What sets of axes are written in (search/method/minimal.h).
    constexpr std::size_t kMostAxes = 63;
    if (space.axes.size() == kMostAxes) {
      context.report(Situation::kSpaceRange, axis.span, "expected at most 63 axes in a space");
      return;
    }
    const auto before = std::ranges::find_if(space.axes, [&](const SpaceAxis& one) {
      return one.name == axis.name ||
             (one.kind == SpaceAxisKind::kPlace && axis.kind == SpaceAxisKind::kPlace &&
              one.object == axis.object);
    });
    if (before == space.axes.end()) {
      space.axes.push_back(std::move(axis));
      return;
    }
    // Other statements that are said twice are reported as such.
    const bool adds_up = axis.kind == SpaceAxisKind::kPlace ||
                         axis.kind == SpaceAxisKind::kTemplate ||
                         axis.kind == SpaceAxisKind::kPhrase;
    if (!adds_up) return;
    context.report(Code::P0203, axis.span, "`" + axis.name + "` varies twice in this space")
        .label(before->span, "first said here");
  }

  static SpaceAxis axis_of(SpaceAxisKind kind, const Span& span, const std::string& whose = "") {
    SpaceAxis axis;
    axis.kind = kind;
    axis.span = span;
    axis.name = std::string(info_of(kind).label);
    // "camera.x" of `third_view` is camera.third_view.x.
    if (!whose.empty()) {
      const std::size_t dot = axis.name.find('.');
      axis.name.insert(dot == std::string::npos ? axis.name.size() : dot, "." + whose);
    }
    return axis;
  }

  // The axis between two ends that the text has; P1601 where the task is not between them.
  void range(SpaceAxis axis, double low, double high, double own, const char* what) {
    axis.low = low;
    axis.high = high;
    axis.own = own;
    const double scale = info_of(axis.kind).per_si;
    const std::string unit(info_of(axis.kind).unit);
    const auto said = [&](double value) {
      return number_text(value * scale) + (unit == "steps" ? " steps" : unit);
    };
    if (!(low < high)) {
      context.report(Situation::kSpaceRange, axis.span,
                     "expected a range that goes up, found " + said(low) + " .. " + said(high));
    } else if (own < low || own > high) {
      context
          .report(Situation::kSpaceOwn, axis.span,
                  "`" + task.name + "` itself has " + std::string(what) + " of " + said(own) +
                      ", which is not in " + said(low) + " .. " + said(high))
          .help("a search begins where the task is: let the range begin, end or go on behind " +
                said(own));
    } else {
      add(std::move(axis));
    }
  }
  void range(SpaceAxisKind kind, const syntax::SpaceRange& written, const Dimension& dimension,
             const Takes& takes, double own, const char* what, double most = 1e12) {
    const auto low = read_si(context, written.low, dimension, takes);
    const auto high = read_si(context, written.high, dimension, takes);
    if (!low || !high) return;
    const Span span = join(written.low.span, written.high.span);
    const bool is_factor = info_of(kind).spacing == Spacing::kRatio;
    if (is_factor ? *low <= 0 : *low < 0) {
      context.report(is_factor ? Situation::kNotPositive : Situation::kNegative, written.low.span,
                     is_factor ? "expected a factor of more than 0" : "expected 0 or more");
      return;
    }
    if (*high > most) {
      context.report(Situation::kColorRange, written.high.span,
                     "expected at most " + number_text(most) + std::string(info_of(kind).unit));
      return;
    }
    range(axis_of(kind, span), *low, *high, own, what);
  }
  // From the task, which is at 0, up to so far away from it.
  void within(SpaceAxis axis, const syntax::Quantity& written, const Dimension& dimension,
              const Takes& takes, double most) {
    const auto value = read_positive(context, written, dimension, takes);
    if (!value) return;
    if (*value > most) {
      context.report(Situation::kCameraTurn, written.span, "expected at most half a turn");
      return;
    }
    axis.high = *value;
    add(std::move(axis));
  }
  void nothing(const Span& span, const std::string& why, const std::string& help) {
    auto& said = context.report(Situation::kSpaceNothing, span, why);
    if (!help.empty()) said.help(help);
  }

  void operator()(const syntax::SpaceLightStmt& stmt) {
    const Light& light = context.model.lights[light_of(context.model, task)];
    if (stmt.ambient)
      range(SpaceAxisKind::kAmbient, *stmt.ambient, dim::kNumber,
            {"`ambient` takes numbers", plan::Magnitude::kLight}, light.ambient,
            "an ambient light");
    const bool has_lamps = !light.suns.empty() || !light.lamps.empty();
    if (!has_lamps && (stmt.power || stmt.direction)) {
      nothing(stmt.span, "light `" + light.name + "` of `" + task.name + "` has no sun to vary",
              "give it one, or vary `ambient` alone");
      return;
    }
    if (stmt.power)
      range(SpaceAxisKind::kPower, *stmt.power, dim::kNumber,
            {"`power` takes factors of what the light has", plan::Magnitude::kLight}, 1,
            "a factor");
    if (!stmt.direction) return;
    const auto turns = [](const plan::LampRecord& lamp) {
      return lamp.kind != static_cast<std::uint32_t>(plan::LampKind::kHeadlight);
    };
    if (light.suns.empty() && std::ranges::none_of(light.lamps, turns)) {
      nothing(stmt.direction->span, "a headlight shines along its camera, whatever is said", "");
      return;
    }
    within(axis_of(SpaceAxisKind::kDirection, stmt.direction->span), *stmt.direction, dim::kAngle,
           {"`direction within` takes an angle"}, std::numbers::pi);
  }

  void operator()(const syntax::SpaceCameraStmt& stmt) {
    const auto view = std::ranges::find(views, stmt.view.text, &View::name);
    if (view == views.end()) {
      std::vector<std::string_view> known;
      for (const View& one : views) known.push_back(one.name);
      report_unknown(context.diagnostics, "view", stmt.view, known);
      return;
    }
    // It was taken from one place.
    if (view->overlay) {
      context
          .report(Situation::kPhotoShaken, stmt.span,
                  "the photo `" + view->overlay->text + "` behind the picture of `" + view->name +
                      "` stays where it was taken")
          .label(view->overlay->span, "the photo")
          .help("a task in a scene without it, `scene { camera " +
                context.model.cameras[view->camera].name + " }`, shows its meshes instead");
      return;
    }
    const auto index = static_cast<std::uint32_t>(view - views.begin());
    if (stmt.place) {
      const auto far = read_point(context, *stmt.place, 3, 3, dim::kLength,
                                  {"a camera is moved by lengths", plan::Magnitude::kLength});
      if (!far) return;
      constexpr SpaceAxisKind kAlong[] = {SpaceAxisKind::kCameraX, SpaceAxisKind::kCameraY,
                                          SpaceAxisKind::kCameraZ};
      bool any = false;
      for (std::size_t i = 0; i < 3; ++i) {
        const double most = (*far)[i].si();
        if (most < 0) {
          context.report(Situation::kNegative, stmt.place->span, "expected lengths of 0 or more");
          return;
        }
        if (most == 0) continue;
        any = true;
        SpaceAxis axis = axis_of(kAlong[i], stmt.place->span, view->name);
        axis.view = index;
        axis.low = -most;
        axis.high = most;
        add(std::move(axis));
      }
      if (!any) nothing(stmt.place->span, "a camera that is moved by nothing stays", "");
    }
    if (!stmt.turn) return;
    SpaceAxis axis = axis_of(SpaceAxisKind::kCameraTurn, stmt.turn->span, view->name);
    axis.view = index;
    within(std::move(axis), *stmt.turn, dim::kAngle, {"a camera is turned by an angle"},
           std::numbers::pi / 2);
  }

  void operator()(const syntax::SpacePlaceStmt& stmt) {
    for (const syntax::SpacePlaceStmt::Disc& disc : stmt.discs) {
      ObjectId object = ObjectId::kNone;
      if (find_role(context, disc.what.text)) {
        const auto role = find_single_role(context, disc.what);
        if (!role) continue;
        const auto filled = task.objects_in(*role);
        if (!filled.empty()) object = filled.front();
      } else if (const auto known = find_thing(context, disc.what)) {
        object = *known;
      } else {
        continue;
      }
      const std::vector<ObjectId> objects = task.objects();
      const Layout& layout = context.model.layouts[task.layout];
      const bool is_there = std::ranges::find(objects, object) != objects.end();
      const std::string called(disc.what.text);
      if (!is_there) {
        nothing(disc.what.span,
                "`" + called + "` is no object of `" + task.name + "` that lies somewhere",
                "a disc is for what a layout places");
        continue;
      }
      const auto stands_on_something = [&](const Place& place) {
        return place.is_put() && std::ranges::any_of(place.what, [&](const Spelled& what) {
                 if (what.text == context.model.objects[object].name) return true;
                 const auto role = find_role(context, what.text);
                 const auto filled = role ? task.objects_in(*role) : std::vector<ObjectId>{};
                 return std::ranges::find(filled, object) != filled.end();
               });
      };
      if (std::ranges::any_of(layout.places, stands_on_something)) {
        nothing(disc.what.span,
                "layout `" + layout.name + "` puts `" + called +
                    "` on or in something, whose place is its own",
                "move what carries it");
        continue;
      }
      SpaceAxis axis = axis_of(SpaceAxisKind::kPlace, join(disc.what.span, disc.radius.span),
                               std::string(disc.what.text));
      axis.object = object;
      within(std::move(axis), disc.radius, dim::kLength, Takes::places("`disc` takes a length"),
             1e9);
    }
  }

  void operator()(const syntax::SpaceClutterStmt& stmt) {
    const std::vector<ObjectId> there = task.objects();
    bool fits = true;
    for (const syntax::Name& name : stmt.from) {
      const auto found = context.symbols.objects.find(name, context.diagnostics);
      fits = fits && found.has_value();
      if (!found) continue;
      const auto object = static_cast<ObjectId>(*found);
      if (std::ranges::find(space.clutter, object) != space.clutter.end()) {
        context.report(Code::P0203, name.span, "`" + std::string(name.text) + "` is listed twice")
            .help("where more lie around than are listed, the list begins anew");
        fits = false;
      }
      if (std::ranges::find(there, object) != there.end()) {
        nothing(name.span, "`" + std::string(name.text) + "` is in `" + task.name + "` already",
                "clutter is of what the task has not");
        fits = false;
      }
      space.clutter.push_back(object);
    }
    if (!fits) return;
    constexpr std::uint64_t kMost = 12;
    if (stmt.least.value != 0) {
      context
          .report(Situation::kSpaceOwn, stmt.least.span,
                  "`" + task.name + "` itself has no clutter, so the range begins with 0")
          .help("its own distractors stay, and are not counted");
      return;
    }
    if (stmt.most.value == 0 || stmt.most.value > kMost) {
      context.report(Situation::kSpaceRange, stmt.most.span,
                     "expected at most 1 to " + std::to_string(kMost) + " things around");
      return;
    }
    SpaceAxis axis = axis_of(SpaceAxisKind::kClutter, stmt.span);
    axis.high = static_cast<double>(stmt.most.value);
    add(std::move(axis));
  }

  void operator()(const syntax::SpaceWordsStmt& stmt) {
    for (const syntax::SpaceWordsStmt::Pool& pool : stmt.pools) {
      SpaceAxis axis;
      if (pool.is_templates) {
        axis = axis_of(SpaceAxisKind::kTemplate, pool.of.span);
        axis.choices = {""};  // its own
        const std::string frame = fold_case(pool.of.text);
        bool is_known = false;
        Task other = task;
        std::vector<std::string> said = {task.prompt.empty() ? render_prompt(context.model, task)
                                                             : task.prompt};
        std::vector<std::string_view> frames;
        for (std::size_t i = 0; i < context.model.templates.size(); ++i) {
          const TemplateId id = context.model.templates.id(i);
          const Template& words = context.model.templates[id];
          if (!words.name.empty() && std::ranges::find(frames, words.frame) == frames.end())
            frames.push_back(words.frame);
          is_known = is_known || words.frame == frame;
          if (words.frame != frame || words.name.empty() || !fills_all(task, words) ||
              !counts_fit(context.model, task, words))
            continue;
          other.say = id;
          const std::string text = other.prompt = render_prompt(context.model, other);
          if (std::ranges::find(said, text) != said.end() || !differs(context.model, other, task))
            continue;
          said.push_back(text);
          axis.choices.push_back(words.name);
        }
        if (!is_known) {
          report_unknown(context.diagnostics, "frame", pool.of, frames);
          continue;
        }
      } else {
        const auto role = find_single_role(context, pool.of);
        if (!role) continue;
        const auto filled = task.objects_in(*role);
        axis = axis_of(SpaceAxisKind::kPhrase, pool.of.span, std::string(pool.of.text));
        axis.role = *role;
        const Spelled* own = task.refer_of(*role);
        axis.choices = {own == nullptr ? "" : own->text};
        if (!filled.empty()) {
          for (const Phrase& phrase : context.model.objects[filled.front()].phrases) {
            if (own == nullptr || own->text != phrase.name) axis.choices.push_back(phrase.name);
          }
        }
      }
      if (axis.choices.size() < 2) {
        nothing(pool.of.span,
                pool.is_templates ? "no other template of `" + std::string(pool.of.text) +
                                        "` fits `" + task.name + "`"
                                  : "what fills `" + std::string(pool.of.text) + "` in `" +
                                        task.name + "` has no phrase to be called by",
                "");
        continue;
      }
      axis.high = static_cast<double>(axis.choices.size() - 1);
      add(std::move(axis));
    }
  }

  void operator()(const syntax::SpaceSensorStmt& stmt) {
    const plan::SensorRecord& own = context.model.cameras[views.front().camera].sensor;
    for (const View& view : views) {
      if (context.model.cameras[view.camera].sensor == own) continue;
      nothing(stmt.span,
              "the cameras of `" + task.name + "` have sensors of their own, `" +
                  views.front().name + "` and `" + view.name + "` different ones",
              "give them one, or take one of the two away");
      return;
    }
    if (stmt.noise)
      range(SpaceAxisKind::kNoise, *stmt.noise, dim::kNumber, {"`noise` takes numbers"}, own.noise,
            "a noise", 1);
    if (stmt.blur)
      range(SpaceAxisKind::kBlur, *stmt.blur, dim::kPixel, {"`blur` takes pixels"}, own.blur,
            "a blur", plan::kMaxBlur);
    if (stmt.exposure)
      range(SpaceAxisKind::kExposure, *stmt.exposure, dim::kNumber, {"`exposure` takes factors"},
            own.exposure == 0 ? 1 : own.exposure, "an exposure", plan::kMaxExposure);
  }

  void operator()(const syntax::SpaceDelayStmt& stmt) {
    const Takes takes = "`delay` takes times";
    const auto low = read_si(context, stmt.range.low, dim::kTime, takes);
    const auto high = read_si(context, stmt.range.high, dim::kTime, takes);
    if (!low || !high) return;
    const Robot& robot = context.model.robots[context.model.scenes[task.scene].robot];
    const auto steps = [&](double time) { return std::round(time * robot.control_hz); };
    if (*low < 0) {
      context.report(Situation::kNegative, stmt.range.low.span, "expected 0 or more");
    } else if (steps(*high) >= static_cast<double>(task.horizon)) {
      context.report(Situation::kSpaceRange, stmt.range.high.span,
                     "expected a delay that is shorter than the episode, which has " +
                         std::to_string(task.horizon) + " steps");
    } else if (steps(*low) == steps(*high)) {
      context.report(Situation::kSpaceRange, stmt.span,
                     "expected a range over several steps of " + number_text(robot.control_hz) +
                         "Hz, found one: " + number_text(steps(*low)));
    } else {
      range(axis_of(SpaceAxisKind::kDelay, stmt.span), steps(*low), steps(*high), task.delay,
            "a delay");
    }
  }
};

// What a search makes of a space is called by the space, an axis, the number of a level and of a
// start, clutter by the point and the object that it copies; all of them name files. These parts
// leave room for the numbers, an extension and what a file is called while it is written.
constexpr std::size_t kMostOfPoint = 200;  // bytes, of the 255 that a file's name may have

void check_names_of_points(Context& context, const Space& space) {
  if (space.name.size() > plan::kMaxNameBytes) return;  // reported
  for (const SpaceAxis& axis : space.axes) {
    std::string longest;  // of the objects that are copied
    if (axis.kind == SpaceAxisKind::kClutter) {
      for (const ObjectId object : space.clutter) {
        const std::string& name = context.model.objects[object].name;
        if (name.size() > longest.size()) longest = name;
      }
    }
    const std::size_t size =
        space.name.size() + 1 + axis.name.size() + (longest.empty() ? 0 : 1 + longest.size());
    if (size <= kMostOfPoint) continue;
    context
        .report(Situation::kTextTooLong, space.span,
                "expected names of points of at most " + std::to_string(kMostOfPoint) +
                    " bytes, which name files, found " + std::to_string(size) + ": the space's, `" +
                    axis.name + (longest.empty() ? "`" : "` and `" + longest + "`"))
        .help("a shorter name: that of the space begins the name of each of its points");
    return;
  }
}

}  // namespace

void define_spaces(Context& context) {
  for (const auto& declared : context.symbols.space_decls) {
    const syntax::SpaceDecl& node = *declared.node;
    Space space;
    space.name = std::string(node.name.text);
    space.span = node.name.span;
    const std::size_t errors = context.diagnostics.error_count();
    const auto found = context.symbols.tasks.find(node.of, context.diagnostics);
    space.broken = !found || !declared.decl->complete;
    if (found) {
      space.of = static_cast<TaskId>(*found);
      const Task& task = context.model.tasks[space.of];
      if (task.abstract) {
        context.report(Situation::kSpaceNothing, node.of.span,
                       "`" + task.name + "` is abstract, and nothing runs it");
      } else if (!task.complete) {
        space.broken = true;  // reported
      } else {
        SpaceReader reader{context, space, task, views_of(context.model, task)};
        for (const syntax::SpaceStmt& stmt : node.body) std::visit(reader, stmt);
        if (space.axes.empty() && context.diagnostics.error_count() == errors)
          context.report(Situation::kSpaceNothing, node.name.span, "nothing varies in this space")
              .help(
                  "say what may, and how far: `light ambient 0.05 .. 0.6`, `clutter 0 .. 4 from "
                  "(..)`, `place source in disc 5cm`");
      }
    }
    check_names_of_points(context, space);
    space.broken = space.broken || context.diagnostics.error_count() != errors;
    context.model.spaces.push_back(std::move(space));
  }
}

}  // namespace probe::sema
