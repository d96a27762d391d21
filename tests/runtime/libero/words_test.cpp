// How the benchmark's things are called and what is said of them goes into their declarations.
#include "runtime/libero/words.h"

#include <doctest/doctest.h>

namespace probe::libero {
namespace {

bool everything(std::string_view) { return true; }

}  // namespace

TEST_CASE("a declaration gets the name that instructions have, and what it proves") {
  const std::string text = described(
      "wine_bottle",
      "object wine_bottle {\n  mesh \"wine_bottle\"\n  density 1kg/m3; friction 0.95; name "
      "\"wine bottle model\"\n}\n",
      everything);
  CAPTURE(text);
  CHECK(text.find("friction 0.95; name \"wine bottle\"\n") != std::string::npos);
  CHECK(text.find("package bottle; category drink") != std::string::npos);
  CHECK(text.ends_with("\n}\n"));
  CHECK(described("teapot", "object teapot {}\n", everything) == "object teapot {}\n");
}

TEST_CASE("parts and regions of a fixture are called as instructions call them") {
  const std::string text = described(
      "white_cabinet",
      "fixture white_cabinet {\n  part cabinet_top link cabinet_top name \"cabinet top\"\n"
      "  region top_side of white_cabinet box (0cm, 0cm, 0cm) .. (1cm, 1cm, 1cm)\n}\n",
      everything);
  CAPTURE(text);
  CHECK(text.find("link cabinet_top name \"top drawer\"\n") != std::string::npos);
  CHECK(text.find("(1cm, 1cm, 1cm) name \"top of the cabinet\"\n") != std::string::npos);
  CHECK(name_of("white_cabinet", "top_side") == "top of the cabinet");
  CHECK(name_of("white_cabinet", "lid").empty());
  CHECK(name_of("akita_black_bowl") == "black bowl");
  CHECK(set_of("akita_black_bowl") == "bowls");
  CHECK(set_of("basket").empty());
}

TEST_CASE("phrases of what a folder does not have are left out") {
  const auto bowl = [](const std::function<bool(std::string_view)>& is_there) {
    return described("akita_black_bowl",
                     "object akita_black_bowl {\n  friction 0.95; name \"x\"\n}\n", is_there);
  };
  CHECK(bowl(everything).find("nearest(plate_1)") != std::string::npos);
  const std::string some = bowl([](std::string_view name) { return name == "plate_1"; });
  CHECK(some.find("nearest(plate_1)") != std::string::npos);
  CHECK(some.find("nearest(cookies_1)") == std::string::npos);
  CHECK(some.find("kind bowl and leftmost") != std::string::npos);
}

}  // namespace probe::libero
