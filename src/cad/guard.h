// Calls into OpenCASCADE: its exceptions become errors, its printing is kept quiet.
#pragma once

#include <Message_SequenceOfPrinters.hxx>
#include <Standard_Failure.hxx>
#include <exception>
#include <new>
#include <string>
#include <utility>

#include "base/error.h"

namespace curvetet {

/// While alive, OpenCASCADE's default messenger has no printers.
class QuietMessages {
 public:
  QuietMessages();
  ~QuietMessages();
  QuietMessages(const QuietMessages&) = delete;
  QuietMessages& operator=(const QuietMessages&) = delete;

 private:
  Message_SequenceOfPrinters printers_;
};

/// Calls body() and returns its result; an exception out of OpenCASCADE becomes an error with the given code.
template <class Body>
auto guarded(ErrorCode code, const std::string& what, Body&& body) -> decltype(body()) {
  const auto failed = [&](const std::string& why) {
    return Error{code, what + ": " + (why.empty() ? "the CAD kernel failed" : "the CAD kernel says: " + why)};
  };
  try {
    return std::forward<Body>(body)();
  } catch (const Standard_Failure& failure) {
    const char* text = failure.GetMessageString();
    return failed(text != nullptr ? text : "");
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::memory_limit, what + ": out of memory"};
  } catch (const InternalError&) {
    throw;
  } catch (const std::exception& failure) {
    return failed(failure.what());
  }
}

}  // namespace curvetet
