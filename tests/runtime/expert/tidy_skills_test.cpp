// Several things that go to one place share it.
#include "runtime/expert/tidy_skills.h"

#include <doctest/doctest.h>

namespace probe::expert {
namespace {

using policy::Skill;

constexpr int kBasket = 0;

policy::Privileged a_basket_and_three() {
  policy::Privileged view;
  view.objects.resize(4);
  view.objects[kBasket].parts = {{{-0.1, -0.05, 0}, {0.1, 0.05, 0.08}}};
  return view;
}

Skill put(int object, Skill::Place place) {
  Skill skill;
  skill.kind = Skill::Kind::kPut;
  skill.object = object;
  skill.place = place;
  skill.to_object = kBasket;
  return skill;
}

TEST_CASE("what is put on or in one object shares it, whichever is said; what is alone does not") {
  const policy::Privileged view = a_basket_and_three();
  using enum Skill::Place;
  const auto shared = tidied(view, {put(1, kIn), put(2, kIn), put(3, kOn)});
  REQUIRE(shared.size() == 3);
  for (const Skill& skill : shared) {
    CHECK(skill.shares);
    REQUIRE(skill.region.has_value());
    CHECK(skill.region->high.x() == doctest::Approx(0.07));
    CHECK(skill.region->low.y() == doctest::Approx(-0.035));
  }
  CHECK(is_shared(shared, 0));
  CHECK(is_shared(shared, 1));
  CHECK_FALSE(is_shared(shared, 2));  // nothing comes behind it
  const auto alone = tidied(view, {put(1, kIn), put(2, kBeside)});
  for (const Skill& skill : alone) {
    CHECK_FALSE(skill.shares);
    CHECK_FALSE(skill.region.has_value());
  }
}

}  // namespace
}  // namespace probe::expert
