// What a batch knows about bodies that are done: a line of JSON for each in a file that survives whatever ends the
// batch.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "batch_bodies.h"
#include "curvetet/error.h"

namespace curvetet::cli {

/// What became of one body.
struct BatchRow {
  std::string body, mesh, report;
  std::vector<std::string> options;  ///< for this body alone
  bool valid = false;
  int exit = 0;         ///< -1: no exit code
  std::string cause;    ///< the first error's code, or "did not end in time", "killed by ...", empty if valid
  std::string message;  ///< of the first error
  std::vector<std::string> entities;
  std::optional<Vec3> where;
  double seconds = 0;
  double size = 0, worst_dihedral = 0;
  std::size_t points = 0, tets = 0, triangles = 0;
};

/// Reads what the report says into the row; a report that is missing or broken leaves it as it is.
void read_report(const std::string& path, BatchRow& row);

/// The results of a folder. At most one object at a time, over all processes, holds a folder.
class BatchResults {
 public:
  BatchResults() = default;
  ~BatchResults();
  BatchResults(const BatchResults&) = delete;
  BatchResults& operator=(const BatchResults&) = delete;

  /// Makes the folder if there is none, locks it and reads what is there. A last line that is not whole is cut off; it
  /// was being written when a batch was killed. Errors: another batch is at work there, the folder cannot be written,
  /// or holds results of other options (but with `restart`, which forgets them).
  Status open(const std::string& folder, const std::vector<std::string>& options, bool restart);
  /// Appends a row and waits until it is on the disk.
  Status add(const BatchRow& row);
  bool is_done(const BatchBody& body) const { return done_.count({body.name, body.options}) > 0; }
  /// Leaves out the rows of what is not among the bodies: of an earlier list for the same folder.
  void keep_only(const std::vector<BatchBody>& bodies);
  const std::vector<BatchRow>& rows() const { return rows_; }
  /// Counts by cause, and of the valid ones, into summary.json.
  Status write_summary(std::size_t bodies) const;
  std::map<std::string, std::size_t> causes() const;
  std::size_t valid() const;

 private:
  using Key = std::pair<std::string, std::vector<std::string>>;  ///< name and options

  Status lock();
  Status keep_options(const std::vector<std::string>& options, bool restart);
  Status read_rows();

  std::string folder_;
  int lock_ = -1, file_ = -1;
  std::vector<BatchRow> rows_;
  std::set<Key> done_;
};

}  // namespace curvetet::cli
