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

// A .probe text with one object declaration a model, which checks whatever the models are called.
// Names that are no identifiers get `model_` before them and underscores in them, equal ones a
// number behind them. Of a folder that no text can name, or a box or density that no plan can hold,
// a comment says that it is left out.
std::string catalogue_text(const std::vector<CatalogueObject>& objects);

}  // namespace probe::assets
