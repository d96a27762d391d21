#include "compiler/names/context.h"

#include <algorithm>
#include <cstdio>

namespace probe::sema {

std::optional<std::uint32_t> NameTable::declare(const syntax::Name& name,
                                                Diagnostics& diagnostics) {
  const auto index = static_cast<std::uint32_t>(names_.size());
  const auto [at, is_new] = by_text_.try_emplace(name.text, index);
  if (!is_new) {
    diagnostics
        .report(Code::P0203, name.span,
                kind_ + " `" + std::string(name.text) + "` is declared twice")
        .label(names_[at->second].span, "first declared here");
    return std::nullopt;
  }
  names_.push_back(name);
  return index;
}

std::optional<std::uint32_t> NameTable::peek(std::string_view text) const {
  const auto at = by_text_.find(text);
  if (at == by_text_.end()) return std::nullopt;
  return at->second;
}

std::optional<std::uint32_t> NameTable::find(const syntax::Name& name,
                                             Diagnostics& diagnostics) const {
  if (const auto found = peek(name.text)) return found;
  std::vector<std::string_view> candidates;
  for (const syntax::Name& known : names_) candidates.push_back(known.text);
  report_unknown(diagnostics, kind_, name, candidates);
  return std::nullopt;
}

Diagnostic& report_unknown(Diagnostics& diagnostics, std::string_view kind,
                           const syntax::Name& name,
                           const std::vector<std::string_view>& candidates) {
  Diagnostic& diagnostic = diagnostics.report(
      Code::P0201, name.span, "unknown " + std::string(kind) + " `" + std::string(name.text) + "`");
  auto near = nearest(name.text, candidates);
  if (!near && name.text.size() > 2) {
    // `bridge` for `bridge_v2`: the only one that begins so.
    const auto begins = [&](std::string_view known) {
      return known.starts_with(std::string(name.text) + "_");
    };
    if (std::count_if(candidates.begin(), candidates.end(), begins) == 1)
      near = *std::find_if(candidates.begin(), candidates.end(), begins);
  }
  if (near) {
    const std::string text(*near);
    diagnostic.point("did you mean `" + text + "`?")
        .fix_by("write `" + text + "`", name.span, text);
  }
  return diagnostic;
}

namespace {

template <typename Node>
void collect(NameTable& names, std::vector<Declared<Node>>& decls, Context& context,
             const syntax::File& file, const syntax::Decl& decl, const Node& node) {
  if (names.declare(node.name, context.diagnostics)) decls.push_back({&file, &decl, &node});
}

void collect_task(Context& context, DeclaredTask task) {
  if (context.symbols.tasks.declare(task.name, context.diagnostics)) {
    context.symbols.task_decls.push_back(std::move(task));
  }
}

struct Collector {
  Context& context;
  const syntax::File& file;
  const syntax::Decl& decl;

  Symbols& symbols() const { return context.symbols; }

  void operator()(const syntax::UseDecl&) const {}
  void operator()(const syntax::DatasetDecl& node) const {
    collect(symbols().datasets, symbols().dataset_decls, context, file, decl, node);
  }
  void operator()(const syntax::AttributeDecl& node) const {
    collect(symbols().attributes, symbols().attribute_decls, context, file, decl, node);
  }
  void operator()(const syntax::FactsDecl& node) const {
    for (const syntax::Name& name : node.names) symbols().facts.declare(name, context.diagnostics);
  }
  void operator()(const syntax::ObjectDecl& node) const {
    collect(symbols().objects, symbols().object_decls, context, file, decl, node);
  }
  void operator()(const syntax::RobotDecl& node) const {
    collect(symbols().robots, symbols().robot_decls, context, file, decl, node);
  }
  void operator()(const syntax::CameraDecl& node) const {
    collect(symbols().cameras, symbols().camera_decls, context, file, decl, node);
  }
  void operator()(const syntax::LightDecl& node) const {
    collect(symbols().lights, symbols().light_decls, context, file, decl, node);
  }
  void operator()(const syntax::SceneDecl& node) const {
    collect(symbols().scenes, symbols().scene_decls, context, file, decl, node);
  }
  void operator()(const syntax::LayoutDecl& node) const {
    collect(symbols().layouts, symbols().layout_decls, context, file, decl, node);
  }
  void operator()(const syntax::TemplateDecl& node) const {
    collect(symbols().templates, symbols().template_decls, context, file, decl, node);
  }
  void operator()(const syntax::PredicateDecl& node) const {
    collect(symbols().predicates, symbols().predicate_decls, context, file, decl, node);
  }
  void operator()(const syntax::MetricsDecl& node) const {
    collect(symbols().metrics, symbols().metrics_decls, context, file, decl, node);
  }
  void operator()(const syntax::TaskDecl& node) const {
    collect_task(context,
                 {&file, &decl, node.name, node.abstract, node.like, node.against, &node.body});
  }
  // `variant X of Y` is `task X like Y against Y`.
  void operator()(const syntax::VariantDecl& node) const {
    collect_task(context, {&file, &decl, node.name, false, node.of,
                           node.against ? *node.against : node.of, &node.body});
  }
  void operator()(const syntax::VariantsDecl& node) const {
    for (const syntax::VariantsMember& member : node.members) {
      collect_task(context, {&file, &decl, member.name, false, node.of, node.of, &member.body});
    }
  }
  // Its tasks are made when those that it goes over are known.
  void operator()(const syntax::DeriveDecl& node) const {
    symbols().derive_decls.push_back({&file, &decl, &node});
  }
  void operator()(const syntax::SetDecl& node) const {
    collect(symbols().sets, symbols().set_decls, context, file, decl, node);
  }
  void operator()(const syntax::SuiteDecl& node) const {
    collect(symbols().suites, symbols().suite_decls, context, file, decl, node);
  }
};

}  // namespace

void collect_names(Context& context) {
  for (const syntax::File* file : context.files) {
    for (const syntax::Decl& decl : file->decls) {
      std::visit(Collector{context, *file, decl}, decl.node);
    }
  }
}

// ---- quantities
// -----------------------------------------------------------------------------------------------------

std::optional<Quantity> read_quantity(Context& context, const syntax::Quantity& written,
                                      const Dimension& wanted, std::string_view takes) {
  if (written.unit == syntax::Unit::kUnknown) {
    ++context.unread;
    return std::nullopt;
  }
  const std::string digits = (written.negative ? "-" : "") + std::string(written.digits);
  const auto quantity = make_quantity(digits, to_text(written.unit));
  if (!quantity) {
    context
        .report(Code::P0304, written.span,
                "`" + digits + "` has more digits or a larger exponent than is kept")
        .help("18 digits, values below 1e14, steps down to 1e-18");
    return std::nullopt;
  }
  if (quantity->dimension == wanted) return quantity;
  Diagnostic& diagnostic =
      context.report(Code::P0302, written.span,
                     "expected " + name_of(wanted) + ", found " + name_of(quantity->dimension));
  diagnostic.point(std::string(takes));
  // A layout's numbers are seen beside the first surface they may mean.
  const bool is_place =
      takes.starts_with("`grid") || takes.starts_with("`spread") || takes.starts_with("`place");
  if (quantity->dimension == dim::kNumber && is_place && context.model.scenes.size() != 0 &&
      context.model.scenes[static_cast<SceneId>(0)].complete) {
    const std::array<double, 4>& area = context.model.scenes[static_cast<SceneId>(0)].area;
    char depth[32];
    std::snprintf(depth, sizeof depth, "%.4gcm", (area[2] - area[0]) * 100);
    diagnostic.help("the surface is " + std::string(depth) + " deep: did you mean `" + digits +
                    "cm`?");
  } else if (quantity->dimension == dim::kNumber && !usual_unit(wanted).empty()) {
    diagnostic.help("a unit touches its number: `" + digits + std::string(usual_unit(wanted)) +
                    "`");
  }
  return std::nullopt;
}

std::optional<double> read_si(Context& context, const syntax::Quantity& written,
                              const Dimension& wanted, std::string_view takes) {
  const auto quantity = read_quantity(context, written, wanted, takes);
  if (!quantity) return std::nullopt;
  return quantity->si();
}

std::optional<double> read_positive(Context& context, const syntax::Quantity& written,
                                    const Dimension& wanted, std::string_view takes) {
  const auto value = read_si(context, written, wanted, takes);
  if (value && !(*value > 0)) {
    context
        .report(Code::P0304, written.span,
                "expected a value above zero, found `" +
                    std::string(context.sources.text(written.span)) + "`")
        .point(std::string(takes));
    return std::nullopt;
  }
  return value;
}

std::optional<std::vector<Quantity>> read_point(Context& context, const syntax::Point& point,
                                                std::size_t least, std::size_t most,
                                                const Dimension& wanted, std::string_view takes) {
  const std::size_t count = point.coordinates.size();
  if (count < least || count > most) {
    const std::string wants = least == most ? std::to_string(least)
                                            : std::to_string(least) + " or " + std::to_string(most);
    context
        .report(Code::P0302, point.span,
                "expected " + wants + " coordinates, found " + std::to_string(count))
        .point(std::string(takes));
    return std::nullopt;
  }
  std::vector<Quantity> values;
  for (const syntax::Quantity& coordinate : point.coordinates) {
    const auto value = read_quantity(context, coordinate, wanted, takes);
    if (value) values.push_back(*value);
  }
  if (values.size() != count) return std::nullopt;
  return values;
}

Turn make_turn(const Quantity* roll, const Quantity* pitch, const Quantity* yaw) {
  const SinCos none{0, 1};
  const SinCos x = roll ? roll->sincos_half() : none;
  const SinCos y = pitch ? pitch->sincos_half() : none;
  const SinCos z = yaw ? yaw->sincos_half() : none;
  // Extrinsic x, then y, then z: q = qz qy qx. Adding 0.0 turns -0.0 into 0.0, so that equal turns
  // have equal bytes.
  return {{z.cos * y.cos * x.cos + z.sin * y.sin * x.sin + 0.0,
           z.cos * y.cos * x.sin - z.sin * y.sin * x.cos + 0.0,
           z.cos * y.sin * x.cos + z.sin * y.cos * x.sin + 0.0,
           z.sin * y.cos * x.cos - z.cos * y.sin * x.sin + 0.0}};
}

std::optional<Turn> read_turn(Context& context, const syntax::Pose& pose) {
  std::array<std::optional<Quantity>, 3> turns;
  for (const syntax::Angle& angle : pose.angles) {
    auto& slot = turns[static_cast<std::size_t>(angle.turn)];
    const auto value = read_quantity(context, angle.value, dim::kAngle, "a turn is an angle");
    if (!value) return std::nullopt;
    if (slot) {
      context.report(Code::P0203, angle.span, "a pose turns about each axis once");
      return std::nullopt;
    }
    slot = value;
  }
  const auto pointer = [](const std::optional<Quantity>& value) {
    return value ? &*value : nullptr;
  };
  return make_turn(pointer(turns[0]), pointer(turns[1]), pointer(turns[2]));
}

std::optional<std::vector<Turn>> read_turns(Context& context,
                                            const std::vector<syntax::Pose>& poses) {
  std::vector<Turn> turns;
  for (const syntax::Pose& pose : poses) {
    if (const auto turn = read_turn(context, pose)) turns.push_back(*turn);
  }
  if (turns.size() != poses.size()) return std::nullopt;
  return turns;
}

std::vector<std::uint32_t> parents_first(Context& context,
                                         std::vector<std::optional<std::uint32_t>>& parents,
                                         const std::vector<syntax::Name>& names) {
  enum : std::uint8_t { kNew, kOpen, kDone };
  std::vector<std::uint8_t> states(parents.size(), kNew);
  std::vector<std::uint32_t> order;
  std::vector<std::uint32_t> chain;
  for (std::uint32_t start = 0; start < parents.size(); ++start) {
    chain.clear();
    std::optional<std::uint32_t> at = start;
    while (at && states[*at] == kNew) {
      states[*at] = kOpen;
      chain.push_back(*at);
      at = parents[*at];
    }
    if (at && states[*at] == kOpen) {
      std::string circle = "`" + std::string(names[*at].text) + "`";
      for (auto member = std::find(chain.begin(), chain.end(), *at) + 1; member != chain.end();
           ++member) {
        circle += " -> `" + std::string(names[*member].text) + "`";
      }
      context
          .report(Code::P0207, names[*at].span,
                  "`" + std::string(names[*at].text) + "` copies itself")
          .note(circle + " -> `" + std::string(names[*at].text) + "`");
      parents[chain.back()] = std::nullopt;
    }
    for (auto member = chain.rbegin(); member != chain.rend(); ++member) {
      states[*member] = kDone;
      order.push_back(*member);
    }
  }
  return order;
}

}  // namespace probe::sema
