#include "assets/make/generators.h"

namespace probe::make {

std::vector<OutputFile> make_all() {
  std::vector<OutputFile> all;
  for (auto* make : {make_carrot, make_plate, make_widowx, make_table_scene}) {
    for (OutputFile& file : make()) all.push_back(std::move(file));
  }
  return all;
}

}  // namespace probe::make
