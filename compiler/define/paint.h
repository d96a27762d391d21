// What objects and scenes look like other than their meshes do: paint and textures.
#pragma once

#include <optional>

#include "compiler/names/context.h"

namespace probe::sema {

// The colour of a `paint` statement: by a name of paints.def, or three shares of full red, green
// and blue as a picture has them. Nothing, and P0201, P0302 or P0304, when it is none.
std::optional<Paint> read_paint(Context& context, const syntax::PaintStmt& stmt);

// P1510 where a painted object is said to have a colour (its attribute `color`) that the paint is
// not: the paint is clearly nearer to another colour of paints.def than to any that is said. A
// colour that paints.def does not have is not looked at.
void check_paint(Context& context, const Object& object);

// Whether people would call both by one word: red and a darker red.
bool are_alike(const Paint& a, const Paint& b);

// The attribute that says what is seen of paint; nothing in a text that has none.
std::optional<AttributeId> color_attribute(const Model& model);

// `side`: what one picture covers where the statement does not say it, m.
std::optional<Cover> read_cover(Context& context, const syntax::TextureStmt& stmt, double side);

}  // namespace probe::sema
