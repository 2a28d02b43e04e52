// Appending a line is the only change, so what a kill can leave behind is a last line without its end. Rejected: a
// database; a line of JSON is what a user's own scripts read.
#include "batch_results.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "curvetet/curvetet.h"
#include "curvetet/formats.h"

namespace curvetet::cli {

namespace {

using nlohmann::json;

std::string in(const std::string& folder, const char* name) { return (std::filesystem::path(folder) / name).string(); }

Error unwritable(const std::string& path, const std::string& why) {
  return {ErrorCode::output_unwritable, fmt::format("{} cannot be written: {}", path, why), {}, {}, ""};
}

json to_json(const BatchRow& row) {
  json line{{"body", row.body},
            {"options", row.options},
            {"status", row.valid ? "valid" : "failed"},
            {"exit", row.exit},
            {"cause", row.cause},
            {"message", row.message},
            {"entities", row.entities},
            {"seconds", row.seconds},
            {"size", row.size},
            {"points", row.points},
            {"tets", row.tets},
            {"triangles", row.triangles},
            {"worst_dihedral", row.worst_dihedral},
            {"mesh", row.mesh},
            {"report", row.report}};
  line["where"] = row.where ? json::array({row.where->x, row.where->y, row.where->z}) : json();
  return line;
}

/// Throws json::exception if the line is no row.
BatchRow from_json(const json& line) {
  BatchRow row;
  row.body = line.at("body").get<std::string>();
  row.options = line.value("options", std::vector<std::string>());
  row.valid = line.at("status").get<std::string>() == "valid";
  row.cause = line.value("cause", "");
  row.seconds = line.value("seconds", 0.0);
  return row;
}

json read_json(const std::string& path) {
  std::ifstream file(path);
  return json::parse(file, nullptr, false);
}

}  // namespace

void read_report(const std::string& path, BatchRow& row) {
  const json report = read_json(path);
  if (!report.is_object()) return;
  try {
    const auto part = [&](const char* name) {
      const json found = report.value(name, json());
      return found.is_object() ? found : json::object();
    };
    row.size = part("options").value("size", 0.0);
    const json counts = part("counts");
    row.points = counts.value("points", std::size_t{0});
    row.tets = counts.value("tets", std::size_t{0});
    row.triangles = counts.value("triangles", std::size_t{0});
    row.worst_dihedral = part("quality").value("worst_dihedral", 0.0);
    const json errors = report.value("errors", json::array());
    if (errors.empty()) return;
    const json& first = errors.front();
    row.cause = first.value("code", "");
    row.message = first.value("message", "");
    row.entities = first.value("entities", std::vector<std::string>());
    if (const json where = first.value("where", json()); where.is_array() && where.size() == 3)
      row.where = Vec3{where[0].get<double>(), where[1].get<double>(), where[2].get<double>()};
  } catch (const json::exception&) {
    row.message = "its report is not what a report should be";
  }
}

BatchResults::~BatchResults() {
  if (file_ >= 0) ::close(file_);
  if (lock_ >= 0) ::close(lock_);
}

Status BatchResults::open(const std::string& folder, const std::vector<std::string>& options, bool restart) {
  folder_ = folder;
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (code) return unwritable(folder, code.message());
  if (Status status = lock(); !status) return status;
  if (Status status = keep_options(options, restart); !status) return status;
  const std::string path = in(folder_, "results.jsonl");
  file_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | (restart ? O_TRUNC : 0), 0644);
  if (file_ < 0) return unwritable(path, std::strerror(errno));
  return read_rows();
}

Status BatchResults::lock() {
  const std::string path = in(folder_, ".batch.lock");
  lock_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (lock_ < 0) return unwritable(path, std::strerror(errno));
  if (::flock(lock_, LOCK_EX | LOCK_NB) == 0) return Done{};
  return Error{ErrorCode::output_unwritable,
               "another batch is at work in " + folder_,
               {},
               {},
               "wait for it, or give this one a folder of its own"};
}

Status BatchResults::keep_options(const std::vector<std::string>& options, bool restart) {
  const std::string path = in(folder_, "batch.json");
  const json mine{{"version", version()}, {"options", options}};
  std::error_code ignored;
  if (!restart && std::filesystem::exists(path, ignored)) {
    const json known = read_json(path);
    if (known == mine) return Done{};
    return Error{ErrorCode::bad_option,
                 folder_ + " holds the results of a batch with other options, or of another version",
                 {},
                 {},
                 "choose another folder, or forget them with --restart"};
  }
  return write_file_atomically(path, mine.dump(2) + "\n");
}

Status BatchResults::read_rows() {
  const std::string path = in(folder_, "results.jsonl");
  std::ifstream file(path);
  std::stringstream content;
  content << file.rdbuf();
  const std::string text = content.str();
  std::size_t begin = 0;
  for (std::size_t end = text.find('\n'); end != std::string::npos; begin = end + 1, end = text.find('\n', begin)) {
    try {
      rows_.push_back(from_json(json::parse(text.begin() + static_cast<std::ptrdiff_t>(begin),
                                            text.begin() + static_cast<std::ptrdiff_t>(end))));
      done_.insert({rows_.back().body, rows_.back().options});
    } catch (const json::exception&) {
      return Error{ErrorCode::file_unreadable,
                   fmt::format("{} is damaged after {} lines", path, rows_.size()),
                   {},
                   {},
                   "mend that line, or start over with --restart"};
    }
  }
  if (::ftruncate(file_, static_cast<off_t>(begin)) != 0 || ::lseek(file_, 0, SEEK_END) < 0)
    return unwritable(path, std::strerror(errno));
  return Done{};
}

Status BatchResults::add(const BatchRow& row) {
  const std::string line = to_json(row).dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
  for (std::size_t written = 0; written < line.size();) {
    const ssize_t n = ::write(file_, line.data() + written, line.size() - written);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return unwritable(in(folder_, "results.jsonl"), std::strerror(errno));
    written += static_cast<std::size_t>(n);
  }
  if (::fsync(file_) != 0 && errno != EINVAL) return unwritable(in(folder_, "results.jsonl"), std::strerror(errno));
  rows_.push_back(row);
  done_.insert({row.body, row.options});
  return Done{};
}

void BatchResults::keep_only(const std::vector<BatchBody>& bodies) {
  std::set<Key> wanted;
  for (const BatchBody& body : bodies) wanted.insert({body.name, body.options});
  std::erase_if(rows_, [&](const BatchRow& row) { return wanted.count({row.body, row.options}) == 0; });
}

std::size_t BatchResults::valid() const {
  return static_cast<std::size_t>(
      std::count_if(rows_.begin(), rows_.end(), [](const BatchRow& row) { return row.valid; }));
}

std::map<std::string, std::size_t> BatchResults::causes() const {
  std::map<std::string, std::size_t> counts;
  for (const BatchRow& row : rows_)
    if (!row.valid) ++counts[row.cause];
  return counts;
}

Status BatchResults::write_summary(std::size_t bodies) const {
  const json summary{{"bodies", bodies}, {"done", rows_.size()}, {"valid", valid()}, {"failed_by_cause", causes()}};
  return write_file_atomically(in(folder_, "summary.json"), summary.dump(2) + "\n");
}

}  // namespace curvetet::cli
