// Somebody else's program, with the C library's sine: loads the library that is its argument, as
// Python loads a module, and says whether the sines in it are ours, once it is asked to bind them,
// and its own is what it was. Exits with 0 if so, else with the number of what is not.
#include <dlfcn.h>

#include <array>
#include <cmath>

namespace {

using Function = double (*)(double);

// Arguments of which the C library's sine and ours differ in the last bit.
constexpr int kTried = 4000;
double argument(int i) { return 0.3 + 0.001 * i; }

int differing(Function a, Function b) {
  int count = 0;
  for (int i = 0; i < kTried; ++i) count += a(argument(i)) != b(argument(i)) ? 1 : 0;
  return count;
}

}  // namespace

int main(int, char** words) {
  void* library = ::dlopen(words[1], RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) return 1;
  const auto find = [&](const char* name) {
    return reinterpret_cast<Function>(::dlsym(library, name));
  };
  const Function ours = find("our_sine"), here = find("sine_here");
  const Function stranger = find("sine_of_stranger"), both = find("both_of_stranger");
  volatile double x = argument(7);
  std::array<double, kTried> before;
  for (int i = 0; i < kTried; ++i)
    before[static_cast<std::size_t>(i)] = std::sin(argument(i) * x / x);
  // The test would show nothing if the two sines never differed.
  if (differing(ours, here) == 0 || differing(ours, stranger) == 0) return 2;
  const auto bind = reinterpret_cast<int (*)()>(::dlsym(library, "bind_to_ours"));
  if (bind() < 3) return 3;
  if (differing(ours, here) != 0) return 4;
  if (differing(ours, stranger) != 0) return 5;
  if (differing(find("our_both"), both) != 0) return 6;
  if (bind() < 3 || differing(ours, stranger) != 0) return 7;
  for (int i = 0; i < kTried; ++i) {
    if (before[static_cast<std::size_t>(i)] != std::sin(argument(i) * x / x)) return 8;
  }
  return 0;
}
