// The judge does not allocate while an episode runs: every allocation of this program is counted.
#include <doctest/doctest.h>

#include <cstdlib>
#include <new>

#include "runtime/vm/judge.h"
#include "tests/runtime/vm/random_judge.h"

namespace {

std::size_t allocations = 0;

void* counted(std::size_t size) {
  ++allocations;
  void* const memory = std::malloc(size == 0 ? 1 : size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t size) { return counted(size); }
void* operator new[](std::size_t size) { return counted(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace probe::vm {

TEST_CASE("a step of the judge allocates nothing") {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const plan::Plan plan = RandomProgram(seed).make(80);
    RandomWorld world(seed);
    const auto starts = world.starts();
    std::vector<StepSample> samples;
    for (int i = 1; i <= 10; ++i) samples.push_back(world.step(i));
    Judge judge(plan, 0);
    REQUIRE(judge.begin(starts).ok());
    const std::size_t before = allocations;
    bool ok = true;
    for (const StepSample& sample : samples) ok = judge.step(sample).ok() && ok;
    const std::size_t after = allocations;
    CHECK(ok);
    CHECK(after == before);
    // The counter itself works.
    const std::size_t base = allocations;
    delete new int(1);
    CHECK(allocations >= base);
  }
}

}  // namespace probe::vm
