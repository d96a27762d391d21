// make_assets OUTPUT_DIR: writes every generated asset and manifest.json. The outputs are checked
// in under assets/.
#include <cstdio>

#include "assets/make/generators.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: make_assets OUTPUT_DIR\n", stderr);
    return 1;
  }
  const probe::Status status = probe::make::write_files(argv[1], probe::make::make_all());
  if (!status.ok()) {
    std::fprintf(stderr, "make_assets: %s\n", probe::to_text(status.failure()).c_str());
    return 2;
  }
  return 0;
}
