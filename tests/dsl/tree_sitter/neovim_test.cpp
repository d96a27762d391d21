#include <unistd.h>

#include "tests/dsl/tree_sitter/tree.h"

using namespace probe;

TEST_CASE("Neovim loads the parser, colours with its queries and follows what is typed") {
  if (std::system("command -v nvim >/dev/null 2>&1") != 0) {
    MESSAGE("SKIPPED: nvim is not here");
    return;
  }
  // As a plugin lies on the disk: parser/probe.so, queries/probe/*.scm.
  std::string pattern = (test::fs::temp_directory_path() / "probe_nvim_XXXXXX").string();
  const test::fs::path folder = mkdtemp(pattern.data());
  test::fs::create_directory_symlink(VLAPROBE_BINARY_DIR "/tree-sitter/parser", folder / "parser");
  test::fs::create_directory(folder / "queries");
  test::fs::create_directory_symlink(test::kGrammar / "queries", folder / "queries/probe");
  std::ofstream(folder / "a.probe") << "object b { density 1kg/m3 }\nobject c like b { }\n"
                                       "task a { source b }\n";
  const std::string at = folder.string();
  const std::string line = "HOME='" + at + "' XDG_CONFIG_HOME='" + at + "' VLAPROBE_TOLD='" + at +
                           "/told' VLAPROBE_RUNTIME='" + at + "' VLAPROBE_FILE='" + at +
                           "/a.probe' timeout 60 nvim --headless -u NONE -i NONE -n -c 'luafile " +
                           (test::kRoot / "tests/dsl/tree_sitter/neovim.lua").string() + "' >'" +
                           at + "/log' 2>&1";
  CHECK(std::system(line.c_str()) == 0);
  CHECK_MESSAGE(
      test::text_of(folder / "told") ==
          "root: file\nmistakes: false\ntypes: 4\nfolds: 3\ntyped: false\nwithout ): true\n"
          "shown: yes\n",
      test::text_of(folder / "told"), test::text_of(folder / "log"));
  test::fs::remove_all(folder);
}
