// The helper process of the tests: the real one, and three ways to misbehave, chosen by the name of the file to be
// read.
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <string>
#include <thread>

#include "cad/load.h"
#include "cad/transfer.h"

int main(int argc, char** argv) {
  if (argc < 4) return 2;
  const std::string path = argv[2];
  if (path.find("silent") != std::string::npos) return 0;
  if (path.find("crash") != std::string::npos || path.find("hang") != std::string::npos) {
    if (!curvetet::announce_transfer(argv[3])) return 3;
    if (path.find("crash") != std::string::npos) std::raise(SIGSEGV);
    while (true) std::this_thread::sleep_for(std::chrono::seconds(1));
  }
  return curvetet::run_cad_helper(argc, argv);
}
