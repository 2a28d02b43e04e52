#include "batch_bodies.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

namespace curvetet::cli {

namespace {

namespace fs = std::filesystem;

bool is_cad_file(const fs::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto known = {".step", ".stp", ".iges", ".igs", ".brep", ".brp"};
  return std::find(known.begin(), known.end(), ending) != known.end();
}

Error not_found(const std::string& source, const std::string& why) {
  return {ErrorCode::file_not_found, source + " " + why, {}, {}, "give a list of CAD files, or a folder of them"};
}

/// The line with what is no part of a plain file name replaced; a number is added where it is taken.
std::string stem_of(const std::string& name, std::set<std::string>& taken) {
  std::string stem;
  for (const char c : name) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-' || c == '_' || c == '+';
    if (plain && !(stem.empty() && c == '.')) stem += c;
    if (c == '/' && !stem.empty()) stem += "__";
    if (c == '\t') stem += '_';
  }
  if (stem.empty()) stem = "body";
  constexpr std::size_t kLongest = 200;  // leaves room for endings
  if (stem.size() > kLongest) stem = stem.substr(stem.size() - kLongest);
  std::string unique = stem;
  for (int k = 2; !taken.insert(unique).second; ++k) unique = stem + "-" + std::to_string(k);
  return unique;
}

Result<std::vector<std::string>> names_in_folder(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code code;
  for (fs::recursive_directory_iterator it(folder, fs::directory_options::skip_permission_denied, code), end;
       !code && it != end; it.increment(code)) {
    if (it->is_regular_file(code) && is_cad_file(it->path()))
      names.push_back(it->path().lexically_relative(folder).string());
  }
  if (code) return not_found(folder.string(), "cannot be read: " + code.message());
  std::sort(names.begin(), names.end());
  return names;
}

Result<std::vector<std::string>> lines_of(const std::string& list) {
  std::ifstream file(list);
  if (!file) return not_found(list, "cannot be opened");
  std::vector<std::string> lines;
  std::set<std::string> taken;
  for (std::string line; std::getline(file, line);) {
    const std::size_t begin = line.find_first_not_of(" \t\r"), end = line.find_last_not_of(" \t\r");
    if (begin == std::string::npos || line[begin] == '#') continue;
    line = line.substr(begin, end + 1 - begin);
    if (line.find('\0') != std::string::npos) return not_found(list, "is no list: a list is text");
    if (taken.insert(line).second) lines.push_back(line);
  }
  return lines;
}

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  std::stringstream stream(line);
  for (std::string field; std::getline(stream, field, '\t');)
    if (!field.empty()) fields.push_back(field);
  return fields;
}

}  // namespace

Result<std::vector<BatchBody>> find_bodies(const std::string& source) {
  std::error_code code;
  const bool folder = fs::is_directory(source, code);
  const Result<std::vector<std::string>> lines = folder ? names_in_folder(source) : lines_of(source);
  if (!lines) return lines.error();
  if (lines.value().empty()) return not_found(source, "names no CAD file");
  const fs::path root = folder ? fs::path(source) : fs::path(source).parent_path();
  std::vector<BatchBody> bodies;
  std::set<std::string> taken;
  for (const std::string& line : lines.value()) {
    const std::vector<std::string> fields = folder ? std::vector{line} : fields_of(line);
    BatchBody body{fields.front(), {}, (root / fields.front()).string(), stem_of(line, taken)};
    body.options.assign(fields.begin() + 1, fields.end());
    bodies.push_back(std::move(body));
  }
  return bodies;
}

}  // namespace curvetet::cli
