// dsl/tutorial.md as a reader does it: each block written into the file, each command run, what it
// shows held to what the page says.
#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace {

std::string read(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

struct Block {
  std::string kind, heading;
  std::vector<std::string> lines;
};

std::vector<Block> blocks_of(const std::string& page) {
  std::vector<Block> blocks;
  std::string heading;
  bool is_inside = false;
  for (const std::string& line : lines_of(page)) {
    if (is_inside && line == "```") {
      is_inside = false;
    } else if (is_inside) {
      blocks.back().lines.push_back(line);
    } else if (line.starts_with("## ")) {
      heading = line.substr(3);
    } else if (line.starts_with("```")) {
      is_inside = true;
      blocks.push_back({line.substr(3), heading, {}});
    }
  }
  return blocks;
}

struct Declaration {
  std::string key;  // "task coke_on_plate"
  std::string text;
};

// The words before what is said of it: two, three where the first belongs to the second.
std::string key_of(const std::string& line) {
  std::istringstream words(line);
  std::string first, second, third;
  words >> first >> second >> third;
  const bool is_long = first == "abstract" || first == "extend" || first == "variants";
  return first + " " + second + (is_long ? " " + third : "");
}

std::vector<Declaration> declarations_in(const Block& block) {
  std::vector<Declaration> all;
  for (const std::string& line : block.lines) {
    const bool begins = !line.empty() && line[0] != ' ' && line[0] != '}' && line[0] != '#';
    if (begins) all.push_back({key_of(line), ""});
    if (!all.empty()) all.back().text += line + "\n";
  }
  return all;
}

// As the page tells its reader: what is there already makes room, all else goes to the end.
void write_into(std::vector<Declaration>& file, const Block& block) {
  for (Declaration& declaration : declarations_in(block)) {
    const auto known = std::find_if(file.begin(), file.end(), [&](const Declaration& one) {
      return one.key == declaration.key;
    });
    if (known == file.end()) {
      file.push_back(std::move(declaration));
    } else {
      known->text = std::move(declaration.text);
    }
  }
}

struct Ended {
  int status = 0;
  std::string said;
};

Ended run(const fs::path& folder, const std::string& command) {
  const std::string line = "cd '" + folder.string() +
                           "' && PATH='" VLAPROBE_BINARY_DIR ":'\"$PATH\" " + command + " 2>&1";
  Ended ended;
  FILE* pipe = popen(line.c_str(), "r");
  REQUIRE(pipe != nullptr);
  std::array<char, 4096> part{};
  for (std::size_t n = 0; (n = fread(part.data(), 1, part.size(), pipe)) > 0;)
    ended.said.append(part.data(), n);
  ended.status = WEXITSTATUS(pclose(pipe));
  return ended;
}

std::string without_blanks_at_end(std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  return line;
}

bool says(const std::string& said, const std::string& line) {
  for (const std::string& one : lines_of(said)) {
    if (without_blanks_at_end(one).find(without_blanks_at_end(line)) != std::string::npos)
      return true;
  }
  return false;
}

}  // namespace

TEST_CASE("each step of the tutorial does what it says") {
  const fs::path page = fs::path(VLAPROBE_SOURCE_DIR) / "dsl/tutorial.md";
  const fs::path folder = fs::temp_directory_path() / ("tutorial_" + std::to_string(getpid()));
  fs::create_directories(folder);
  std::vector<Declaration> file;
  std::string said;
  int commands = 0;
  for (const Block& block : blocks_of(read(page))) {
    CAPTURE(block.heading);
    if (block.kind == "probe") {
      write_into(file, block);
      std::ofstream out(folder / "which_can.probe", std::ios::binary);
      for (const Declaration& declaration : file) out << declaration.text;
    } else if (block.kind == "sh") {
      said.clear();
      for (const std::string& line : block.lines) {
        const std::size_t note = line.find("# exits with ");
        const int expected = note == std::string::npos ? 0 : std::atoi(line.c_str() + note + 13);
        const Ended ended = run(folder, line.substr(0, note));
        CHECK_MESSAGE(ended.status == expected, line, "\n", ended.said);
        const bool is_free = note == std::string::npos && line.starts_with("vlaprobe check");
        if (is_free) CHECK_MESSAGE(ended.said.find("no findings") != std::string::npos, ended.said);
        said += ended.said;
        ++commands;
      }
    } else if (block.kind == "text") {
      for (const std::string& line : block.lines)
        CHECK_MESSAGE(says(said, line), line, "\nis not in\n", said);
    }
  }
  CHECK(commands > 30);
  const fs::path pictures = fs::path(VLAPROBE_SOURCE_DIR) / "dsl/tutorial";
  for (const auto& picture : fs::directory_iterator(pictures)) {
    CHECK_MESSAGE(read(picture.path()) == read(folder / picture.path().filename()),
                  picture.path().filename().string(), " is drawn otherwise");
  }
  fs::remove_all(folder);
}
