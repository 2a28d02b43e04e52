#include "cad/guard.h"

#include <Message.hxx>
#include <Message_Messenger.hxx>

namespace curvetet {

QuietMessages::QuietMessages() : printers_(Message::DefaultMessenger()->Printers()) {
  Message::DefaultMessenger()->ChangePrinters().Clear();
}

QuietMessages::~QuietMessages() { Message::DefaultMessenger()->ChangePrinters() = printers_; }

}  // namespace curvetet
