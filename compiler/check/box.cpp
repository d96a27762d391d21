// P0506: an object's `box` against the bounds of its collision mesh. Every other check, and
// `half_height` at run time, believes the box; what touches in the simulation is the mesh.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/check/check.h"
#include "compiler/geometry/mesh_bounds.h"
#include "compiler/geometry/mesh_origin.h"

namespace probe::sema {
namespace {

// A corner may be this far off, or a side this much longer or shorter: what rounding to whole
// millimetres and a hull around a round model explain.
constexpr double kMostOff = 0.005;       // m
constexpr double kMostPart = 0.1;        // of the mesh's side
constexpr double kLeastCounted = 0.001;  // m, below which a part of a thin side is no matter

std::string exact_centimetres(double metres) {
  // To a micrometre; adding 0 turns -0 into 0.
  return fmt::format("{}cm", std::round(metres * 1e6) / 1e4 + 0.0);
}

bool differs(const Object& object, const Bounds& mesh) {
  for (std::size_t i = 0; i < 3; ++i) {
    const double low = std::abs(object.unscaled.box_min[i] - mesh.low[i]);
    const double high = std::abs(object.unscaled.box_max[i] - mesh.high[i]);
    const double side = mesh.high[i] - mesh.low[i];
    const double longer = std::abs(object.unscaled.box_max[i] - object.unscaled.box_min[i] - side);
    if (std::max(low, high) > kMostOff + 1e-9) return true;
    if (longer > kMostPart * side + 1e-9 && longer > kLeastCounted) return true;
  }
  return false;
}

bool is_centred(const Bounds& bounds) {
  constexpr double kCentred = 0.0005;  // m
  for (std::size_t i = 0; i < 3; ++i) {
    if (std::abs(bounds.low[i] + bounds.high[i]) / 2 > kCentred) return false;
  }
  return true;
}

std::string sides(const std::array<double, 3>& low, const std::array<double, 3>& high) {
  return exact_centimetres(high[0] - low[0]) + " x " + exact_centimetres(high[1] - low[1]) + " x " +
         exact_centimetres(high[2] - low[2]);
}

std::string box_statement(const Bounds& bounds) {
  if (is_centred(bounds)) return "box " + sides(bounds.low, bounds.high);
  const auto corner = [](const std::array<double, 3>& at) {
    return "(" + exact_centimetres(at[0]) + ", " + exact_centimetres(at[1]) + ", " +
           exact_centimetres(at[2]) + ")";
  };
  return "box " + corner(bounds.low) + " .. " + corner(bounds.high);
}

}  // namespace

void check_boxes(const Checked& checked, Reporter& reporter) {
  const AssetRoot& asset_root = checked.asset_root;
  for (const Object& object : checked.model.objects) {
    if (object.of) continue;
    const Span& decl = object.decl_span;
    const bool own_box = !object.box_span.is_none() && is_within(object.box_span, decl);
    const bool own_mesh = !object.mesh.span.is_none() && is_within(object.mesh.span, decl);
    // A copy of both is as right or wrong as the original, which is looked at itself.
    if (!object.box_is_read || object.mesh.span.is_none() || (!own_box && !own_mesh)) continue;
    const auto mesh = bounds_of_mesh(asset_root, object.mesh.text);
    if (!mesh || !differs(object, *mesh)) continue;
    const std::string box = box_statement(*mesh);
    Diagnostic& found = reporter.report(Code::P0506, own_box ? object.box_span : object.mesh.span,
                                        "the box of `" + object.name + "` is not that of its mesh");
    const std::string declared =
        "declared " + sides(object.unscaled.box_min, object.unscaled.box_max);
    const std::string measured = "the mesh measures " + sides(mesh->low, mesh->high);
    if (own_box) {
      found.point(declared).label(object.mesh.span, measured);
      found.fix_by("write `" + box + "`", object.box_span, box);
    } else {
      found.point(measured).label(object.box_span, declared);
      found.fix_by("add `" + box + "`",
                   {object.mesh.span.file, object.mesh.span.end, object.mesh.span.end}, "; " + box);
    }
    const std::string text(checked.sources.file(object.mesh.span.file).name());
    found.note("the mesh is " + origin_of(asset_root, text, object.mesh.text));
    if (!file_beside(text, object.mesh.text).empty())
      found.help(pack_advice(text, object.mesh.text));
    if (!is_centred(*mesh))
      found.note("the corners of the mesh are " + box.substr(4) + " in its own frame");
  }
}

}  // namespace probe::sema
