// `object`: its statements over what it copied, and what an `extend` adds.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "compiler/define/attribute.h"
#include "compiler/define/axes.h"
#include "compiler/define/define.h"
#include "compiler/define/fixture.h"
#include "compiler/define/paint.h"
#include "compiler/define/query.h"
#include "compiler/define/record.h"
#include "compiler/define/thing.h"
#include "compiler/names/quantities.h"
#include "compiler/names/texts.h"
#include "runtime/base/utf8.h"
#include "runtime/plan/axes.h"
#include "runtime/plan/limits.h"
#include "runtime/plan/masses.h"
#include "runtime/plan/regions.h"

namespace probe::sema {
namespace {

// Reads the statements of one object over what it copied.
struct ObjectReader {
  Context& context;
  const syntax::File& file;
  Object& object;
  bool has_is = false, has_maybe = false, has_seen = false;
  Span look = {};    // the first `paint` or `texture` here
  Span weight = {};  // the first `density` or `mass`
  bool says_color = false;

  void facts(const std::vector<syntax::Name>& names, Truth truth, bool& begun) {
    // Statements overwrite: a new list replaces the copied one of its kind.
    if (!begun) {
      for (Truth& fact : object.facts) {
        if (fact == truth) fact = Truth::kNo;
      }
    }
    begun = true;
    for (const syntax::Name& name : names) {
      if (const auto fact = context.symbols.facts.find(name, context.diagnostics))
        object.facts[*fact] = truth;
    }
  }

  std::array<double, 3>& box_min() { return object.unscaled.box_min; }
  std::array<double, 3>& box_max() { return object.unscaled.box_max; }
  void begin_box(const Span& span) {
    object.has_box = object.box_is_read = true;
    object.box_span = span;
  }

  void operator()(const syntax::MeshStmt& stmt) { object.mesh = spelled(stmt.path); }
  void operator()(const syntax::BoxSizeStmt& stmt) {
    const syntax::Quantity* sides[] = {&stmt.x, &stmt.y, &stmt.z};
    begin_box(stmt.span);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto side = read_positive(context, *sides[i], dim::kLength,
                                      {"`box` takes lengths", plan::Magnitude::kExtent});
      if (!side) {
        object.box_is_read = false;
        continue;
      }
      // Halving is exact in binary, so the corners are the nearest doubles to the exact ones.
      box_min()[i] = -*side / 2;
      box_max()[i] = *side / 2;
    }
  }
  void operator()(const syntax::BoxCornersStmt& stmt) {
    begin_box(stmt.span);
    object.box_is_read = false;
    const auto low = read_point(context, stmt.low, 3, 3, dim::kLength,
                                {"`box` takes lengths", plan::Magnitude::kPlace});
    const auto high = read_point(context, stmt.high, 3, 3, dim::kLength,
                                 {"`box` takes lengths", plan::Magnitude::kPlace});
    if (!low || !high) return;
    for (std::size_t i = 0; i < 3; ++i) {
      box_min()[i] = (*low)[i].si();
      box_max()[i] = (*high)[i].si();
      const double extent = box_max()[i] - box_min()[i];
      if (extent > 0) {
        if (!check_magnitude(context, stmt.span, extent, plan::Magnitude::kExtent)) return;
        continue;
      }
      context.report(Situation::kCornersSwapped, stmt.span,
                     "the second corner of a box lies above the first on every axis");
      return;
    }
    object.box_is_read = true;
  }
  // What it weighs is said by one of these two; in a copy the later takes the other's place.
  void begin_weight(const Span& span) {
    object.has_density = true;
    object.density = 0;
    object.unscaled.mass.reset();
    if (!weight.is_none())
      context
          .report(Code::P0203, span,
                  "`" + object.name + "` has a density or a mass, not both")
          .label(weight, "first said here");
    weight = span;
  }
  void operator()(const syntax::MassStmt& stmt) {
    begin_weight(stmt.span);
    const auto mass = read_positive(context, stmt.value, dim::kMass,
                                    {"`mass` takes a mass", plan::Magnitude::kMass});
    if (!mass) return;
    Mass& read = object.unscaled.mass.emplace();
    read.mass = *mass;
    if (!stmt.centre) return;
    const auto centre = read_point(context, *stmt.centre, 3, 3, dim::kLength,
                                   {"`com` takes lengths", plan::Magnitude::kPlace});
    const auto inertia = read_point(context, *stmt.inertia, 3, 6, dim::kInertia,
                                    {"`inertia` takes moments in kgm2", plan::Magnitude::kInertia});
    if (!centre || !inertia) return;
    if (inertia->size() != 3 && inertia->size() != 6) {
      context.report(Situation::kInertia, stmt.inertia->span,
                     "an inertia is three moments, or six: xx, yy, zz, xy, xz, yz");
      return;
    }
    read.spread = Mass::Spread{};
    Mass::Spread& spread = *read.spread;
    assign(spread.centre, centre);
    assign(spread.inertia, inertia);
    if (const auto wrong = plan::inertia_fault(spread.inertia))
      context.report(Situation::kInertia, stmt.inertia->span, *wrong);
  }
  // Alone it may be either, as its unit says; of two the first is of shifts.
  void operator()(const syntax::ObjectDampingStmt& stmt) {
    object.damping = {};
    const auto unit = make_quantity("0", to_text(stmt.shift.unit));
    const bool turns = !stmt.turn && unit && unit->dimension == dim::kAngularDamping;
    const auto read = [&](const syntax::Quantity& written, bool is_turn, double& to) {
      const auto value =
          is_turn ? read_si(context, written, dim::kAngularDamping,
                            {"`damping` of turning is in Nms/rad", plan::Magnitude::kGain})
                  : read_si(context, written, dim::kLinearDamping,
                            {"`damping` of moving is in Ns/m, and of turning, behind it, in Nms/rad",
                             plan::Magnitude::kGain});
      if (!value) return;
      if (*value >= 0) {
        to = *value;
        return;
      }
      context.report(Situation::kNegative, written.span, "a damping is not negative");
    };
    read(stmt.shift, turns, turns ? object.damping.turn : object.damping.shift);
    if (stmt.turn) read(*stmt.turn, true, object.damping.turn);
  }
  void operator()(const syntax::DensityStmt& stmt) {
    begin_weight(stmt.span);
    object.density = read_positive(context, stmt.value, dim::kDensity,
                                   {"`density` takes a density", plan::Magnitude::kDensity})
                         .value_or(1);
  }
  void operator()(const syntax::FrictionStmt& stmt) {
    object.has_friction = true;
    object.friction = read_positive(context, stmt.value, dim::kNumber,
                                    {"`friction` takes a number", plan::Magnitude::kFriction})
                          .value_or(1);
  }
  void operator()(const syntax::ScaleStmt& stmt) {
    const auto factor = read_si(context, stmt.factor, dim::kNumber, "`scale` takes a number");
    if (!factor) return;
    if (*factor >= plan::kMinScale && *factor <= plan::kMaxScale) {
      object.scale = *factor;
      object.scale_span = stmt.factor.span;
      return;
    }
    context.report(
        Situation::kScale, stmt.factor.span,
        fmt::format("expected a factor between {} and {}", plan::kMinScale, plan::kMaxScale));
  }
  // A mesh has one look of all these; in a copy the later takes the other's place.
  void begin_look(const Span& span) {
    object.paint.reset();
    object.texture.reset();
    if (!look.is_none())
      context.report(Code::P0203, span, "`" + object.name + "` has a paint or a texture, not both")
          .label(look, "first said here");
    look = span;
  }
  void operator()(const syntax::PaintStmt& stmt) {
    begin_look(stmt.span);
    object.paint = read_paint(context, stmt);
  }
  void operator()(const syntax::TextureStmt& stmt) {
    constexpr double kSide = 0.1;  // m
    begin_look(stmt.span);
    object.texture = read_cover(context, stmt, kSide);
  }
  // Of what is covered anew the copied colour is not known.
  void forget_color() {
    if (look.is_none() || !object.texture || says_color) return;
    for (std::size_t i = 0; i < object.values.size(); ++i) {
      if (context.model.attributes[static_cast<AttributeId>(i)].name == "color")
        object.values[i].clear();
    }
  }
  void operator()(const syntax::IsStmt& stmt) { facts(stmt.facts, Truth::kYes, has_is); }
  void operator()(const syntax::MaybeStmt& stmt) { facts(stmt.facts, Truth::kUnknown, has_maybe); }
  void operator()(const syntax::SeenInStmt& stmt) {
    if (!has_seen) object.seen_in.clear();
    has_seen = true;
    object.unseen = false;
    for (const syntax::Name& name : stmt.datasets) {
      const auto dataset = context.symbols.datasets.find(name, context.diagnostics);
      if (dataset) object.seen_in.push_back(static_cast<DatasetId>(*dataset));
    }
  }
  void operator()(const syntax::UnseenStmt&) {
    object.seen_in.clear();
    object.unseen = true;
  }
  void operator()(const syntax::RestStmt& stmt) {
    if (const auto turns = read_turns(context, stmt.poses)) object.rest = *turns;
  }
  void operator()(const syntax::RegionStmt& stmt) {
    if (auto region = read_region(context, stmt))
      put_region(object.unscaled.regions, std::move(*region));
  }
  void operator()(const syntax::NameStmt& stmt) {
    object.text = spelled(stmt.text);
    if (is_blank(object.text.text))
      context.report(Situation::kNoWords, object.text.span, "an object's name has no words");
    check_text(context.diagnostics, object.text, "an object's name");
    object.bare = stmt.bare;
  }
  void operator()(const syntax::PhraseStmt& stmt) {
    Phrase phrase{std::string(stmt.name.text),
                  plan::Axis::kLanguageAppearance,
                  spelled(stmt.text),
                  stmt.bare,
                  {},
                  {}};
    if (const auto axis = phrase_axis(context.diagnostics, stmt.axis)) phrase.axis = *axis;
    if (is_blank(phrase.text.text))
      context.report(Situation::kNoWords, phrase.text.span, "a phrase has no words");
    check_text(context.diagnostics, phrase.text, "a phrase");
    if (!compile_query(context, file, stmt.means, phrase.means)) return;
    phrase.means_text = std::string(context.sources.text(file[stmt.means].span));
    if (phrase.is_spatial() != (phrase.axis == plan::Axis::kLanguageSpatial) &&
        plan::find_language_axis(stmt.axis.text) != nullptr)
      context.report(Situation::kRelationAxis, stmt.axis.span,
                     phrase.is_spatial() ? "a phrase that says where things are is `spatial`"
                                         : "a `spatial` phrase means a relation");
    for (Phrase& known : object.phrases) {
      if (known.name != phrase.name) continue;
      known = std::move(phrase);
      return;
    }
    object.phrases.push_back(std::move(phrase));
  }
  void operator()(const syntax::AttributeStmt& stmt) {
    const auto attribute = context.symbols.attributes.find(stmt.attribute, context.diagnostics);
    if (!attribute) return;
    std::vector<std::uint32_t>& values = object.values[*attribute];
    says_color = says_color || stmt.attribute.text == "color";
    values.clear();
    for (const syntax::Name& name : stmt.values) {
      if (const auto value = find_value(context, static_cast<AttributeId>(*attribute), name))
        values.push_back(*value);
    }
  }
};

// Box and regions are written of the mesh as it is; factors of 1 leave every bit.
void grow(Object& object) {
  const auto times = [&](std::array<double, 3> point) {
    for (double& value : point) value *= object.scale;
    return point;
  };
  object.box_min = times(object.unscaled.box_min);
  object.box_max = times(object.unscaled.box_max);
  object.regions = object.unscaled.regions;
  object.mass = object.unscaled.mass;
  if (object.mass) {
    const double s = object.scale;
    object.mass->mass *= s * s * s;
    if (auto& spread = object.mass->spread) {
      spread->centre = times(spread->centre);
      for (double& moment : spread->inertia) moment *= s * s * s * s * s;
    }
  }
  for (Region& region : object.regions) {
    region.low = times(region.low);
    region.high = times(region.high);
    if (!region.turned) continue;
    region.turned->middle = times(region.turned->middle);
    region.turned->half = times(region.turned->half);
    plan::box_around(*region.turned, region.low, region.high);
  }
}

// What is thinner is no solid to the physics.
void check_size(Context& context, const Object& object) {
  constexpr double kThinnest = 1e-3;  // m
  if (object.scale_span.is_none() || !is_within(object.scale_span, object.decl_span)) return;
  for (std::size_t i = 0; i < 3; ++i) {
    const double side = object.box_max[i] - object.box_min[i];
    const double unscaled = object.unscaled.box_max[i] - object.unscaled.box_min[i];
    if (side >= kThinnest || unscaled < kThinnest || object.scale > 1) continue;
    context
        .report(Situation::kScale, object.scale_span,
                fmt::format("`{}` would be {:.2g}mm thin, an object has at least 1mm", object.name,
                            1000 * side))
        .label(object.box_span, "its box");
    return;
  }
}

}  // namespace

void read_look(Context& context, const syntax::File& file,
               const std::vector<syntax::ObjectStmt>& body, Object& object) {
  ObjectReader reader{context, file, object};
  for (const syntax::ObjectStmt& stmt : body) std::visit(reader, stmt);
}

namespace {

// What another file may add to an object: what is known of it, never what it is. What is said
// already stays said.
struct Extender {
  Context& context;
  ObjectReader& reader;
  Object& object;

  Diagnostic& repeats(const Span& span, const std::string& what) {
    return context.report(Code::P0203, span, what)
        .label(object.span, "declared here")
        .help("another object of the kind: `object NAME like " + object.name + " { .. }`");
  }
  void read(const auto& stmt) {
    repeats(stmt.span, "`extend` adds attributes, facts, phrases and `seen in`: `" +
                           std::string(context.sources.text(stmt.span)) +
                           "` is said where `" + object.name + "` is declared");
  }
  void read(const syntax::AttributeStmt& stmt) {
    const auto attribute = context.symbols.attributes.peek(stmt.attribute.text);
    if (attribute && !object.values[*attribute].empty()) {
      repeats(stmt.span, "`" + object.name + "` has a `" + std::string(stmt.attribute.text) +
                             "` already");
      return;
    }
    reader(stmt);
  }
  void read_facts(const std::vector<syntax::Name>& names, const auto& stmt, Truth truth) {
    for (const syntax::Name& name : names) {
      const auto fact = context.symbols.facts.peek(name.text);
      if (!fact || object.facts[*fact] == Truth::kNo) continue;
      if (object.facts[*fact] == Truth::kUnknown && truth == Truth::kYes) continue;
      repeats(name.span, "`" + std::string(name.text) + "` is said of `" + object.name + "` already");
      return;
    }
    reader(stmt);
  }
  void read(const syntax::IsStmt& stmt) { read_facts(stmt.facts, stmt, Truth::kYes); }
  void read(const syntax::MaybeStmt& stmt) { read_facts(stmt.facts, stmt, Truth::kUnknown); }
  void read(const syntax::SeenInStmt& stmt) {
    if (object.unseen) {
      repeats(stmt.span, "`" + object.name + "` is `unseen`");
      return;
    }
    for (const syntax::Name& name : stmt.datasets) {
      const auto dataset = context.symbols.datasets.peek(name.text);
      if (!dataset ||
          std::ranges::find(object.seen_in, static_cast<DatasetId>(*dataset)) ==
              object.seen_in.end())
        continue;
      repeats(name.span,
              "`" + object.name + "` is seen in `" + std::string(name.text) + "` already");
      return;
    }
    reader(stmt);
  }
  void read(const syntax::PhraseStmt& stmt) {
    for (const Phrase& known : object.phrases) {
      if (known.name != stmt.name.text) continue;
      repeats(stmt.span, "`" + object.name + "` has a phrase `" + known.name + "` already");
      return;
    }
    reader(stmt);
  }
};

// Objects that no file declares are missed here.
std::map<std::uint32_t, std::vector<const Declared<syntax::ExtendDecl>*>> extensions(
    Context& context) {
  std::map<std::uint32_t, std::vector<const Declared<syntax::ExtendDecl>*>> out;
  for (const auto& declared : context.symbols.extend_decls) {
    if (const auto id = context.symbols.objects.find(declared.node->object, context.diagnostics))
      out[*id].push_back(&declared);
  }
  return out;
}

void extend(Context& context, const Declared<syntax::ExtendDecl>& declared, Object& object) {
  ObjectReader reader{context, *declared.file, object};
  reader.has_is = reader.has_maybe = reader.has_seen = true;  // they add to what is there
  Extender extender{context, reader, object};
  for (const syntax::ObjectStmt& stmt : declared.node->body)
    std::visit([&](const auto& one) { extender.read(one); }, stmt);
}

}  // namespace

void define_objects(Context& context) {
  const auto extending = extensions(context);
  const auto read = [&](const Declared<syntax::ObjectDecl>& declared, Object& object) {
    object.decl_span = declared.decl->span;
    object.values.resize(context.model.attributes.size());
    object.facts.resize(context.model.facts.size(), Truth::kNo);
    ObjectReader reader{context, *declared.file, object};
    for (const syntax::ObjectStmt& stmt : declared.node->body) std::visit(reader, stmt);
    reader.forget_color();
    if (const auto more = extending.find(*context.symbols.objects.peek(object.name));
        more != extending.end()) {
      for (const auto* extension : more->second) extend(context, *extension, object);
    }
    if (object.rest.empty()) object.rest.push_back({});
    grow(object);
    check_size(context, object);
  };
  const auto complete = [&](const Object& object, bool is_read) {
    if (is_read) check_paint(context, object);
    const auto need = [&](bool is_there, std::string_view statement) {
      require(context, is_there, "object", object.name, object.span, statement);
    };
    need(!object.mesh.span.is_none(), "mesh");
    need(object.has_box, "box");
    need(object.has_density, "density");
    need(object.has_friction, "friction");
    need(!object.text.span.is_none(), "name");
  };
  define_records(context, context.symbols.objects, context.symbols.object_decls,
                 context.model.objects, read, complete);
}

}  // namespace probe::sema
