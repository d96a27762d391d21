#include "compiler/define/thing.h"

#include <algorithm>
#include <map>

namespace probe::sema {
namespace {

// `a_name` as words.
std::string spaced(std::string text) {
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\n");
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\n") + 1 - begin);
}

// Before and behind the dot; nothing for a name without one.
std::optional<std::pair<std::string_view, std::string_view>> halves(std::string_view name) {
  const std::size_t dot = name.find('.');
  if (dot == name.npos) return std::nullopt;
  return std::pair(trimmed(name.substr(0, dot)), trimmed(name.substr(dot + 1)));
}

// The first `part.size()` bytes of a name, or the last.
syntax::Name begin_of(const syntax::Name& name, std::string_view part) {
  const auto size = static_cast<std::uint32_t>(part.size());
  return {{name.span.file, name.span.begin, name.span.begin + size}, part};
}
syntax::Name end_of(const syntax::Name& name, std::string_view part) {
  const auto size = static_cast<std::uint32_t>(part.size());
  return {{name.span.file, name.span.end - size, name.span.end}, part};
}

ObjectId thing_of(const Fixture& fixture, std::string_view name) {
  for (const Fixture::Part& part : fixture.parts) {
    if (part.declared && part.name == name) return part.thing;
  }
  for (const Fixture::OwnRegion& own : fixture.regions) {
    if (own.region.name == name) return own.thing;
  }
  return ObjectId::kNone;
}

Object blank(const Context& context, std::string name, const Span& span) {
  Object object;
  object.name = std::move(name);
  object.span = object.decl_span = span;
  object.values.resize(context.model.attributes.size());
  object.facts.resize(context.model.facts.size(), Truth::kNo);
  object.rest.push_back({});
  return object;
}

// What several copies of a fixture say of a part is read once.
using Read = std::map<const syntax::PartStmt*, ObjectId>;

void add_part(Context& context, FixtureId id, std::uint32_t index, Read& read) {
  const Fixture& fixture = context.model.fixtures[id];
  const Fixture::Part& part = fixture.parts[index];
  Object object = blank(context, fixture.body_name(part), part.span);
  object.text = part.text.text.empty() ? Spelled{spaced(part.name), part.span} : part.text;
  if (const auto known = read.find(part.said); known != read.end()) {
    object = context.model.objects[known->second];
    object.name = fixture.body_name(part);
  } else if (part.said != nullptr) {
    const auto mistakes = context.mistakes();
    read_look(context, *part.file, part.said->body, object);
    object.broken = context.mistakes() != mistakes;
    read.emplace(part.said, context.model.objects.id(context.model.objects.size()));
  }
  object.of = OfFixture{id, index, std::nullopt};
  context.model.fixtures[id].parts[index].thing = context.model.objects.add(std::move(object));
}

void add_region(Context& context, FixtureId id, std::uint32_t index) {
  const Fixture& fixture = context.model.fixtures[id];
  const Fixture::OwnRegion& own = fixture.regions[index];
  const Fixture::Part& part = fixture.parts[own.part];
  Object object = blank(context, fixture.name + "." + own.region.name, own.region.span);
  object.of = OfFixture{id, own.part, index};
  object.text = own.text;
  if (object.text.text.empty())
    object.text = part.thing != ObjectId::kNone ? context.model.objects[part.thing].text
                                                : Spelled{spaced(fixture.name), own.region.span};
  context.model.fixtures[id].regions[index].thing = context.model.objects.add(std::move(object));
}

bool has_look(const Object& object) {
  return std::ranges::any_of(object.values, [](const auto& values) { return !values.empty(); }) ||
         std::ranges::any_of(object.facts, [](Truth fact) { return fact != Truth::kNo; }) ||
         !object.phrases.empty();
}

}  // namespace

std::optional<ObjectId> peek_thing(const Context& context, std::string_view name) {
  if (const auto object = context.symbols.objects.peek(name)) return static_cast<ObjectId>(*object);
  const auto parts = halves(name);
  const auto fixture =
      parts ? context.symbols.fixtures.peek(parts->first) : std::optional<std::uint32_t>();
  if (!fixture) return std::nullopt;
  const ObjectId found =
      thing_of(context.model.fixtures[static_cast<FixtureId>(*fixture)], parts->second);
  return found == ObjectId::kNone ? std::nullopt : std::optional(found);
}

std::optional<std::pair<syntax::Name, syntax::Name>> halves_of(const syntax::Name& name) {
  const auto parts = halves(name.text);
  if (!parts) return std::nullopt;
  return std::pair(begin_of(name, parts->first), end_of(name, parts->second));
}

std::optional<ObjectId> find_thing(Context& context, const syntax::Name& name) {
  if (const auto found = peek_thing(context, name.text)) return found;
  const auto parts = halves(name.text);
  if (!parts) {
    (void)context.symbols.objects.find(name, context.diagnostics);
    return std::nullopt;
  }
  const auto index =
      context.symbols.fixtures.find(begin_of(name, parts->first), context.diagnostics);
  if (!index) return std::nullopt;
  const Fixture& fixture = context.model.fixtures[static_cast<FixtureId>(*index)];
  if (fixture.broken) return std::nullopt;
  std::vector<std::string_view> known;
  for (const Fixture::Part& part : fixture.parts) {
    if (part.declared) known.push_back(part.name);
  }
  for (const Fixture::OwnRegion& own : fixture.regions) known.push_back(own.region.name);
  Diagnostic& said =
      report_unknown(context.diagnostics, "part or region of `" + fixture.name + "`",
                     end_of(name, parts->second), known);
  said.label(fixture.span, "the fixture");
  const bool is_joint = std::ranges::any_of(
      fixture.joints, [&](const Fixture::Joint& joint) { return joint.name == parts->second; });
  if (is_joint)
    said.help("`" + std::string(parts->second) +
              "` is a joint; what it moves fills a role: `part NAME link LINK` declares one");
  return std::nullopt;
}

void define_things(Context& context) {
  Read read;
  for (std::size_t f = 0; f < context.model.fixtures.size(); ++f) {
    const FixtureId id = context.model.fixtures.id(f);
    if (context.model.fixtures[id].broken) continue;
    for (std::uint32_t i = 0; i < context.model.fixtures[id].parts.size(); ++i) {
      if (context.model.fixtures[id].parts[i].declared) add_part(context, id, i, read);
    }
    for (std::uint32_t i = 0; i < context.model.fixtures[id].regions.size(); ++i)
      add_region(context, id, i);
  }
}

std::vector<ObjectId> parts_in_scene(const Model& model, const Task& task) {
  std::vector<ObjectId> parts;
  if (task.scene == SceneId::kNone) return parts;
  for (const FixtureId id : model.scenes[task.scene].fixtures) {
    for (const Fixture::Part& part : model.fixtures[id].parts) {
      if (part.thing != ObjectId::kNone) parts.push_back(part.thing);
    }
  }
  return parts;
}

std::vector<ObjectId> denotable(const Model& model, const Task& task) {
  std::vector<ObjectId> all = task.objects();
  for (const ObjectId part : parts_in_scene(model, task)) {
    if (has_look(model.objects[part]) || task.role_of(part) != RoleId::kNone ||
        std::ranges::find(task.part_distractors, part) != task.part_distractors.end())
      all.push_back(part);
  }
  return all;
}

std::vector<std::pair<RoleId, ObjectId>> things_of(const Task& task) {
  std::vector<std::pair<RoleId, ObjectId>> things = task.things();
  for (const ObjectId part : task.part_distractors) things.emplace_back(RoleId::kNone, part);
  return things;
}

const char* kind_of(const Object& object) {
  return !object.of ? "an object" : object.of->is_part() ? "a part" : "a region";
}

}  // namespace probe::sema
