// `derive`: one task for each member of a set and each choice of phrases. What it makes is a
// variant of that member, named by the text of the derive.
#include <algorithm>
#include <charconv>
#include <map>

#include "compiler/define/axes.h"
#include "compiler/define/in_start.h"
#include "compiler/define/remembered.h"
#include "compiler/define/role.h"
#include "compiler/define/scene.h"
#include "compiler/define/set.h"
#include "compiler/define/starts.h"
#include "compiler/define/support.h"
#include "compiler/define/task.h"
#include "compiler/define/template.h"
#include "compiler/define/thing.h"
#include "compiler/define/views.h"
#include "compiler/define/wording.h"
#include "compiler/syntax/lexer.h"
#include "runtime/base/utf8.h"

namespace probe::sema {
namespace {

bool is_identifier(const std::string& text) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  return !text.empty() && is_letter(text[0]) && std::all_of(text.begin(), text.end(), [&](char c) {
    return is_letter(c) || c == '_' || (c >= '0' && c <= '9');
  });
}

// A number in a name: "0.8" is 0_8 and "-3cm" m3cm.
std::string as_name(std::string_view value) {
  std::string name(value);
  std::ranges::replace_if(
      name, [](char c) { return c == '.' || c == '/'; }, '_');
  std::ranges::replace(name, '-', 'm');
  return name;
}

class Derive {
 public:
  Derive(Context& context, TaskTable& table, const Declared<syntax::DeriveDecl>& declared)
      : context_(context), table_(table), declared_(declared), node_(*declared.node) {}

  // False when the limit is reached.
  bool expand() {
    if (!declared_.decl->complete || !check_binders() || !check_name()) return true;
    check_used();
    SetReader reader(context_, SetReader::Mode::kPreview);
    const auto& over = std::get<syntax::BinderTasks>(tasks_->over);
    const std::vector<TaskId> members = reader.read(*declared_.file, over.tasks);
    if (node_.where && !reader.check_condition(*declared_.file, *node_.where)) return true;
    const std::size_t errors = context_.diagnostics.error_count();
    const std::size_t before = context_.symbols.task_decls.size();
    bool any_fits = false, any_broken = false;
    for (const TaskId id : members) {
      if (!table_.is_defined(id)) {
        report_undefined(static_cast<std::uint32_t>(id));
        return true;
      }
      const Task& base = context_.model.tasks[id];
      any_broken = any_broken || !base.complete;
      if (!base.complete) continue;  // reported
      if (node_.where && !reader.holds(*declared_.file, *node_.where, base)) continue;
      any_fits = true;
      if (!expand_phrases(id)) return false;
    }
    if (context_.symbols.task_decls.size() == before && !any_broken &&
        context_.diagnostics.error_count() == errors && !context_.has_errors())
      report_empty(members.empty(), any_fits);
    return true;
  }

 private:
  bool check_binders() {
    bool fits = true;
    std::vector<std::string_view> names;
    for (const syntax::Binder& binder : node_.binders) {
      if (std::find(names.begin(), names.end(), binder.name.text) != names.end()) {
        context_.report(Code::P0203, binder.name.span,
                        "`" + std::string(binder.name.text) + "` is bound twice");
        fits = false;
      }
      names.push_back(binder.name.text);
      if (const auto* phrases = std::get_if<syntax::BinderPhrases>(&binder.over)) {
        fits = phrase_axis(context_.diagnostics, phrases->axis).has_value() && fits;
        fits = find_single_role(context_, phrases->role).has_value() && fits;
      } else if (const auto* templates = std::get_if<syntax::BinderTemplates>(&binder.over)) {
        fits = check_frame(templates->frame) && fits;
      } else if (const auto* objects = std::get_if<syntax::BinderObjects>(&binder.over)) {
        for (const syntax::Name& object : objects->objects)
          fits = find_thing(context_, object).has_value() && fits;
      } else if (const auto* declared = std::get_if<syntax::BinderDeclared>(&binder.over)) {
        for (const syntax::Name& one : declared->names)
          fits = names_of(declared->of).find(one, context_.diagnostics).has_value() && fits;
      } else if (const auto* numbers = std::get_if<syntax::BinderNumbers>(&binder.over)) {
        fits = check_numbers(binder, *numbers) && fits;
      } else if (const auto* others = std::get_if<syntax::BinderDistractors>(&binder.over)) {
        if (others->role.text == "parts") {
          const auto fixture = context_.symbols.fixtures.find(others->task, context_.diagnostics);
          fits =
              fixture && !context_.model.fixtures[static_cast<FixtureId>(*fixture)].broken && fits;
          continue;
        }
        if (others->role.text == "distractors" || find_role(context_, others->role.text)) {
          of_task_.push_back(&others->task);
          continue;
        }
        std::vector<std::string_view> known = role_names(context_);
        known.insert(known.end(), {"distractors", "templates", "parts", "phrases", "variants"});
        report_unknown(context_.diagnostics, "role", others->role, known);
        fits = false;
      } else if (tasks_ == nullptr) {
        tasks_ = &binder;
      } else {
        context_
            .report(Code::P0203, binder.span, "a `derive` varies the tasks of one set, found two")
            .label(tasks_->span, "the first")
            .help("unite them: `for t in a | b`");
        fits = false;
      }
    }
    for (const syntax::Name* task : of_task_) {
      if (tasks_ == nullptr || task->text == tasks_->name.text) continue;
      report_unknown(context_.diagnostics, "binder of tasks", *task, {tasks_->name.text});
      fits = false;
    }
    if (tasks_ != nullptr) return fits;
    context_
        .report(Situation::kStatementMissing, node_.name.text.span,
                "this `derive` goes over no set of tasks")
        .help("add a binder such as `for t in tasks`");
    return false;
  }

  const NameTable& names_of(syntax::BinderDeclared::Of of) const {
    switch (of) {
      case syntax::BinderDeclared::Of::kLights:
        return context_.symbols.lights;
      case syntax::BinderDeclared::Of::kCameras:
        return context_.symbols.cameras;
      case syntax::BinderDeclared::Of::kRobots:
        return context_.symbols.robots;
      case syntax::BinderDeclared::Of::kFixtures:
        return context_.symbols.fixtures;
      case syntax::BinderDeclared::Of::kScenes:
        break;
    }
    return context_.symbols.scenes;
  }

  // Whole numbers of a range without unit; what a list holds is held against its use.
  bool check_numbers(const syntax::Binder& binder, const syntax::BinderNumbers& numbers) {
    constexpr long long kMost = 1000;
    std::vector<syntax::Quantity>& values = numbers_[&binder];
    if (!numbers.last) {
      values = numbers.values;
      return true;
    }
    const auto first = whole_of(numbers.values.front()), last = whole_of(*numbers.last);
    if (!first || !last || *last < *first || *last - *first >= kMost) {
      context_.report(Situation::kRangeOfNumbers, binder.span,
                      "expected a range of at most 1000 whole numbers, such as `0 .. 6`");
      return false;
    }
    for (long long value = *first; value <= *last; ++value) {
      context_.symbols.derived_names.push_back(std::to_string(value < 0 ? -value : value));
      syntax::Quantity number;
      number.span = binder.span;
      number.digits = context_.symbols.derived_names.back();
      number.negative = value < 0;
      values.push_back(number);
    }
    return true;
  }

  static std::optional<long long> whole_of(const syntax::Quantity& written) {
    long long value = 0;
    const char* const end = written.digits.data() + written.digits.size();
    const auto read = std::from_chars(written.digits.data(), end, value);
    if (written.unit != syntax::Unit::kNone || read.ec != std::errc() || read.ptr != end ||
        value > 1'000'000'000)
      return std::nullopt;
    return written.negative ? -value : value;
  }

  // As it is written: "-1.5cm".
  std::string_view text_of(const syntax::Quantity& number) {
    context_.symbols.derived_names.push_back((number.negative ? "-" : "") +
                                             std::string(number.digits) +
                                             std::string(to_text(number.unit)));
    return context_.symbols.derived_names.back();
  }

  bool check_frame(const syntax::Name& frame) {
    std::vector<std::string_view> frames;
    for (const Template& known : context_.model.templates) {
      if (known.frame == fold_case(frame.text)) return true;
      if (!known.name.empty() &&
          std::find(frames.begin(), frames.end(), known.frame) == frames.end())
        frames.push_back(known.frame);
    }
    report_unknown(context_.diagnostics, "frame", frame, frames);
    return false;
  }

  bool check_name() {
    std::vector<std::string_view> names;
    for (const syntax::Binder& binder : node_.binders) names.push_back(binder.name.text);
    bool fits = true;
    for (const syntax::TemplatePart& part : node_.name.parts) {
      const auto* slot = std::get_if<syntax::Slot>(&part);
      if (slot == nullptr) continue;
      if (slot->avoid || slot->the || slot->category) {
        context_.report(Code::P0101, slot->span, "a slot of a name holds a binder alone");
        fits = false;
      } else if (std::find(names.begin(), names.end(), slot->name.text) == names.end()) {
        report_unknown(context_.diagnostics, "binder", slot->name, names);
        fits = false;
      }
    }
    return fits;
  }

  // Whether a statement says the word, or a slot in its text.
  bool is_said_in_body(std::string_view word) const {
    const auto says = [&](const auto& stmt) {
      return says_word(context_.sources.text(stmt.span), word);
    };
    return std::ranges::any_of(
        node_.body, [&](const syntax::TaskStmt& stmt) { return std::visit(says, stmt); });
  }

  // What varies nothing makes variants that are the same, or as many as there are names.
  void check_used() {
    for (const syntax::Binder& binder : node_.binders) {
      if (&binder == tasks_ || is_said_in_body(binder.name.text)) continue;
      context_
          .report(
              Code::P0205, binder.name.span,
              "`" + std::string(binder.name.text) + "` is used in no statement of this `derive`")
          .help("without it the variants differ in nothing but their names");
    }
  }

  void report_empty(bool no_members, bool any_fits) {
    Diagnostic& empty =
        context_.report(Code::P0211, node_.name.text.span, "this `derive` makes no task");
    if (no_members) {
      empty.label(tasks_->span, "no task is in this set");
    } else if (!any_fits) {
      empty.label((*declared_.file)[*node_.where].span, "no task of the set fits this");
    } else {
      for (const syntax::Binder& binder : node_.binders) {
        if (&binder == tasks_) continue;
        empty.label(binder.span, std::holds_alternative<syntax::BinderPhrases>(binder.over)
                                     ? "nothing is left to choose here"
                                     : "nothing here is new to a task of the set");
      }
    }
  }

  void report_undefined(std::uint32_t task_index) {
    const std::string_view task = context_.symbols.tasks.names()[task_index].text;
    // What it copies in the end; a name that no `derive` makes is unknown, which is said later.
    std::optional<std::uint32_t> at = task_index;
    std::string_view copied = task;
    for (std::size_t hops = 0; at && hops <= context_.symbols.task_decls.size(); ++hops) {
      const auto& like = context_.symbols.task_decls[*at].like;
      if (!like) break;
      copied = like->text;
      at = context_.symbols.tasks.peek(copied);
    }
    if (!at && !may_be_derived(copied)) return;
    context_
        .report(Code::P0207, tasks_->span,
                "task `" + std::string(task) + "` is made from tasks of a `derive` below")
        .help("move this `derive` behind it");
  }

  // Whether the name has the literal parts of some `derive` in their order.
  bool may_be_derived(std::string_view name) const {
    for (const auto& derive : context_.symbols.derive_decls) {
      std::size_t at = 0;
      for (const syntax::TemplatePart& part : derive.node->name.parts) {
        const auto* literal = std::get_if<std::string>(&part);
        if (literal == nullptr || at == std::string_view::npos) continue;
        at = name.find(*literal, at);
        if (at != std::string_view::npos) at += literal->size();
      }
      if (at != std::string_view::npos) return true;
    }
    return false;
  }

  // All choices of phrases for one task: the first binder slowest.
  bool expand_phrases(TaskId id) {
    const Task& base = context_.model.tasks[id];
    const std::string_view name =
        context_.symbols.task_decls[static_cast<std::size_t>(id)].name.text;
    std::vector<std::vector<Binding>> rows = {{}};
    for (const syntax::Binder& binder : node_.binders) {
      std::vector<Binding> values;
      if (std::holds_alternative<syntax::BinderNumbers>(binder.over)) {
        for (const syntax::Quantity& number : numbers_[&binder])
          values.push_back({binder.name.text, text_of(number), number});
      } else {
        for (const std::string_view value : choices(binder, base, name))
          values.push_back({binder.name.text, value});
      }
      if (rows.size() * values.size() > kMaxTasks) return report_limit();
      std::vector<std::vector<Binding>> longer;
      for (const std::vector<Binding>& row : rows) {
        for (const Binding& value : values) {
          longer.push_back(row);
          longer.back().push_back(value);
        }
      }
      rows = std::move(longer);
    }
    for (std::vector<Binding>& row : rows) {
      if (!add(id, std::move(row))) return false;
    }
    return true;
  }

  // Whether the phrase means the object alone among those of the task; one that says where things
  // are must in every start.
  bool is_clear(const Task& base, const Phrase& phrase, ObjectId object) {
    if (!phrase.is_spatial())
      return denote(context_.model, denotable(context_.model, base), phrase, object).is_clear();
    std::optional<LayoutProblem> problem;
    const std::vector<Start> starts = clear_starts(
        relations_, context_.model, base,
        enumerate_starts(supports_, context_.model, context_.model.layouts[base.layout], base,
                         kMaxEpisodes, problem));
    return std::all_of(starts.begin(), starts.end(), [&](const Start& start) {
      return InStart(relations_, base, start).denote(phrase, object).is_clear();
    });
  }

  bool has_already(const Task& base, const syntax::BinderDeclared& declared,
                   std::uint32_t index) const {
    const Model& model = context_.model;
    switch (declared.of) {
      case syntax::BinderDeclared::Of::kLights:
        return model.lights[light_of(model, base)] == model.lights[static_cast<LightId>(index)];
      case syntax::BinderDeclared::Of::kCameras: {
        const auto is_it = [&](const View& view) {
          return view.camera == static_cast<CameraId>(index);
        };
        return std::ranges::any_of(views_of(model, base), is_it);
      }
      case syntax::BinderDeclared::Of::kRobots:
        return model.scenes[base.scene].robot == static_cast<RobotId>(index);
      case syntax::BinderDeclared::Of::kFixtures: {
        const std::vector<FixtureId>& there = model.scenes[base.scene].fixtures;
        return std::ranges::find(there, static_cast<FixtureId>(index)) != there.end();
      }
      case syntax::BinderDeclared::Of::kScenes:
        break;
    }
    return base.scene == static_cast<SceneId>(index);
  }

  // What a binder stands for in the variants of one task. What the task has already is no choice:
  // its own objects, and templates that say the same.
  std::vector<std::string_view> choices(const syntax::Binder& binder, const Task& base,
                                        std::string_view name) {
    const Model& model = context_.model;
    std::vector<ObjectId> present = base.objects();
    for (const auto& [role, id] : base.things()) present.push_back(id);
    present.insert(present.end(), base.part_distractors.begin(), base.part_distractors.end());
    std::vector<std::string_view> values;
    if (const auto* phrases = std::get_if<syntax::BinderPhrases>(&binder.over)) {
      const std::vector<ObjectId> filled =
          base.objects_in(*find_role(context_, phrases->role.text));
      if (filled.empty()) return values;
      const ObjectId object = filled.front();
      const plan::AxisInfo* axis = plan::find_language_axis(phrases->axis.text);
      for (const Phrase& phrase : model.objects[object].phrases) {
        if (axis == nullptr || phrase.axis != axis->axis) continue;
        if (!phrases->clear || is_clear(base, phrase, object)) values.push_back(phrase.name);
      }
    } else if (const auto* templates = std::get_if<syntax::BinderTemplates>(&binder.over)) {
      const auto& declared = context_.symbols.templates.names();
      const std::string frame = fold_case(templates->frame.text);
      const auto index = static_cast<std::uint32_t>(&base - &*model.tasks.begin());
      Remembered* const remembered = context_.reporter.depth.remembered;
      if (const auto* known = remembered ? remembered->choices(index, frame) : nullptr) {
        for (const std::uint32_t i : *known) values.push_back(declared[i].text);
        return values;
      }
      std::vector<std::uint32_t> found;
      Task other = base;
      for (std::uint32_t i = 0; i < declared.size(); ++i) {
        other.say = static_cast<TemplateId>(i);
        const Template& words = model.templates[other.say];
        if (words.frame != frame || !fills_all(base, words) || !counts_fit(model, base, words))
          continue;
        other.prompt = render_prompt(model, other);
        // A control of the task's own words is none.
        if (is_control(words) && other.prompt == base.prompt) continue;
        if (!differs(model, other, base)) continue;
        values.push_back(declared[i].text);
        found.push_back(i);
      }
      if (remembered != nullptr) remembered->keep_choices(index, frame, std::move(found));
    } else if (const auto* objects = std::get_if<syntax::BinderObjects>(&binder.over)) {
      for (const syntax::Name& object : objects->objects) {
        const ObjectId id = *peek_thing(context_, object.text);
        if (std::find(present.begin(), present.end(), id) == present.end())
          values.push_back(object.text);
      }
    } else if (const auto* declared = std::get_if<syntax::BinderDeclared>(&binder.over)) {
      for (const syntax::Name& one : declared->names) {
        if (!has_already(base, *declared, *names_of(declared->of).peek(one.text)))
          values.push_back(one.text);
      }
    } else if (const auto* others = std::get_if<syntax::BinderDistractors>(&binder.over)) {
      if (others->role.text == "parts") return parts_of(others->task.text, present);
      const auto role = find_role(context_, others->role.text);
      for (const ObjectId id : role ? base.objects_in(*role) : base.distractors)
        values.push_back(model.objects[id].name);
      if (!role) {
        for (const ObjectId id : base.part_distractors) values.push_back(model.objects[id].name);
      }
    } else {
      values.push_back(name);
    }
    return values;
  }

  // Those of a fixture that a joint moves and that no role of the task has.
  std::vector<std::string_view> parts_of(std::string_view fixture,
                                         const std::vector<ObjectId>& present) {
    std::vector<std::string_view> values;
    const auto id = static_cast<FixtureId>(*context_.symbols.fixtures.peek(fixture));
    for (const Fixture::Part& part : context_.model.fixtures[id].parts) {
      if (part.declared && part.joint && std::ranges::find(present, part.thing) == present.end())
        values.push_back(context_.model.objects[part.thing].name);
    }
    return values;
  }

  bool add(TaskId base, std::vector<Binding> bindings) {
    Symbols& symbols = context_.symbols;
    if (symbols.task_decls.size() >= kMaxTasks) return report_limit();
    std::string name;
    for (const syntax::TemplatePart& part : node_.name.parts) {
      if (const auto* literal = std::get_if<std::string>(&part)) name += *literal;
      const auto* slot = std::get_if<syntax::Slot>(&part);
      if (slot == nullptr) continue;
      for (const Binding& binding : bindings) {
        if (binding.name != slot->name.text) continue;
        // Of a part its own name: `cabinet.top_drawer` gives `top_drawer`.
        name += binding.number ? as_name(binding.value)
                               : std::string(binding.value.substr(binding.value.rfind('.') + 1));
      }
    }
    const Span& span = node_.name.text.span;
    if (!is_identifier(name)) {
      context_.report(Code::P0101, span, "`" + name + "` is no name")
          .point("a name is letters, digits and `_`, a letter first");
      return true;
    }
    if (const auto taken = symbols.tasks.peek(name)) {
      const DeclaredTask& first = symbols.task_decls[*taken];
      Diagnostic& twice =
          context_.report(Code::P0203, span, "task `" + name + "` is declared twice");
      if (first.decl == declared_.decl) {
        twice.help("give every binder a slot in the name");
      } else {
        twice.label(first.name.span, "first declared here");
      }
      return true;
    }
    symbols.derived_names.push_back(std::move(name));
    const bool has_number = std::ranges::any_of(
        bindings, [](const Binding& binding) { return binding.number.has_value(); });
    const auto index = static_cast<std::uint32_t>(symbols.task_decls.size());
    const syntax::Name like{span, symbols.task_decls[static_cast<std::size_t>(base)].name.text};
    DeclaredTask task{declared_.file, declared_.decl, {span, symbols.derived_names.back()},
                      false,          like,           like,
                      &node_.body,    true,           std::move(bindings)};
    (void)symbols.tasks.declare(task.name, context_.diagnostics);
    symbols.task_decls.push_back(std::move(task));
    table_.add_row();
    table_.define(index, static_cast<std::uint32_t>(base));
    table_.compare(index, true);
    // A number that the task has already, such as no distractors, is no choice.
    const Task& made = context_.model.tasks[static_cast<TaskId>(index)];
    if (has_number && made.complete && made.axes == 0) {
      table_.drop_last_row();
      symbols.task_decls.pop_back();
      symbols.tasks.forget_last();
    }
    return true;
  }

  bool report_limit() {
    context_.report(Situation::kTooManyTasks, node_.name.text.span,
                    "the suite grows beyond " + std::to_string(kMaxTasks) + " tasks here");
    return false;
  }

  Context& context_;
  // What cannot be measured is said where the phrase is used.
  Diagnostics unsaid_ = {};
  Relations relations_{context_.model, context_.asset_root, unsaid_};
  Supports supports_{context_.model, context_.asset_root};
  TaskTable& table_;
  const Declared<syntax::DeriveDecl>& declared_;
  const syntax::DeriveDecl& node_;
  const syntax::Binder* tasks_ = nullptr;
  std::map<const syntax::Binder*, std::vector<syntax::Quantity>> numbers_;
  std::vector<const syntax::Name*> of_task_;  // what `distractors of` names
};

}  // namespace

void expand_derives(Context& context, TaskTable& table) {
  for (const auto& declared : context.symbols.derive_decls) {
    if (!Derive(context, table, declared).expand()) return;
  }
}

}  // namespace probe::sema
