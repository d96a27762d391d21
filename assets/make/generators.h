// One generator an asset; together they are every file of assets/ but the robot's description.
#pragma once

#include <vector>

#include "assets/make/files.h"

namespace probe::make {

std::vector<OutputFile> make_carrot();       // objects/carrot/
std::vector<OutputFile> make_plate();        // objects/plate/
std::vector<OutputFile> make_widowx();       // robots/widowx/meshes/
std::vector<OutputFile> make_table_scene();  // scenes/table/

// All of them, without the manifest.
std::vector<OutputFile> make_all();

}  // namespace probe::make
