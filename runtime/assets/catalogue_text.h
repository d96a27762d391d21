// Models of a database as objects of the language, to be used and copied from.
#pragma once

#include <string>
#include <vector>

#include "runtime/base/geometry.h"

namespace probe::assets {

struct CatalogueObject {
  std::string folder;  // below objects: what `mesh` says
  Vec3 min, max;       // m
  double density = 0;  // kg/m3
};

// A .probe text with one object declaration a model. Names that are no identifiers get `model_`
// before them and underscores in them.
std::string catalogue_text(const std::vector<CatalogueObject>& objects);

}  // namespace probe::assets
