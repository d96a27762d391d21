#include "assets/make/generators.h"

namespace probe::make {

std::vector<OutputFile> make_all() {
  std::vector<OutputFile> all;
  for (auto* make :
       {make_apple,        make_baked_cans,    make_baked_goods,   make_basket,
        make_bottle,       make_bowl,          make_mug,           make_tray,
        make_carrot,       make_coke_can,      make_eggplant,      make_green_cube,
        make_half_sponge,  make_keyboard,      make_long_sponge,   make_nut,
        make_orange,       make_orange_juice,  make_pepsi_can,     make_plate,
        make_rabbit,       make_ramekin,       make_slim_can,      make_small_plate,
        make_sponge,       make_spoon,         make_towel,         make_water_bottle,
        make_wheel,        make_wicker_basket, make_yellow_cube,   make_widowx,
        make_panda,        make_google_robot,  make_table_scene,   make_google_table_scene,
        make_sink_fixture, make_sink_scene,    make_kitchen_scene, make_kitchen_fixtures,
        make_textures}) {
    for (OutputFile& file : make()) all.push_back(std::move(file));
  }
  return all;
}

}  // namespace probe::make
