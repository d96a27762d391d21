// One generator an asset; together they are every file of assets/ but the robot's description.
#pragma once

#include <vector>

#include "assets/make/files.h"

namespace probe::make {

// objects/<name>/visual.glb and collision.obj, each.
std::vector<OutputFile> make_apple();
std::vector<OutputFile> make_baked_cans();  // of coke, pepsi and 7up
std::vector<OutputFile> make_baked_goods();  // of apple (the release has two), slim can, sponge
std::vector<OutputFile> make_basket();
std::vector<OutputFile> make_bottle();
std::vector<OutputFile> make_bowl();
std::vector<OutputFile> make_carrot();
std::vector<OutputFile> make_coke_can();
std::vector<OutputFile> make_eggplant();
std::vector<OutputFile> make_green_cube();
std::vector<OutputFile> make_half_sponge();
std::vector<OutputFile> make_keyboard();
std::vector<OutputFile> make_mug();
std::vector<OutputFile> make_long_sponge();
std::vector<OutputFile> make_nut();
std::vector<OutputFile> make_orange();
std::vector<OutputFile> make_orange_juice();
std::vector<OutputFile> make_pepsi_can();
std::vector<OutputFile> make_plate();
std::vector<OutputFile> make_rabbit();
std::vector<OutputFile> make_ramekin();
std::vector<OutputFile> make_slim_can();
std::vector<OutputFile> make_small_plate();
std::vector<OutputFile> make_sponge();
std::vector<OutputFile> make_spoon();
std::vector<OutputFile> make_towel();
std::vector<OutputFile> make_tray();
std::vector<OutputFile> make_water_bottle();
std::vector<OutputFile> make_wheel();
std::vector<OutputFile> make_wicker_basket();
std::vector<OutputFile> make_yellow_cube();

std::vector<OutputFile> make_widowx();            // robots/widowx/meshes/
std::vector<OutputFile> make_panda();             // robots/panda/meshes/
std::vector<OutputFile> make_google_robot();      // robots/google_robot/meshes/
std::vector<OutputFile> make_table_scene();       // scenes/table/
std::vector<OutputFile> make_google_table_scene();  // scenes/google_table/, google_room/
std::vector<OutputFile> make_sink_fixture();      // fixtures/sink/
std::vector<OutputFile> make_sink_scene();        // scenes/sink/
std::vector<OutputFile> make_kitchen_scene();     // scenes/kitchen/
std::vector<OutputFile> make_kitchen_fixtures();  // fixtures/cabinet/, stove/, microwave/
std::vector<OutputFile> make_textures();          // textures/<name>.png

// All of them, without the manifest.
std::vector<OutputFile> make_all();

}  // namespace probe::make
