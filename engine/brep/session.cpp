#include <Message.hxx>
#include <Message_Printer.hxx>
#include <Standard_Failure.hxx>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <vector>

#include "base/file.h"
#include "brep/occt_shape.h"

namespace swarf::brep {
namespace {

std::mutex& library_mutex() {
  static std::mutex mutex;
  return mutex;
}

/// Keeps what is said at the level of an alarm or a failure.
class Listener final : public Message_Printer {
 public:
  std::vector<std::string> lines;

 private:
  void send(const TCollection_AsciiString& text, const Message_Gravity gravity) const override {
    if (gravity < Message_Alarm || text.IsEmpty()) return;
    auto& kept = const_cast<Listener*>(this)->lines;  // the library's interface is const
    const std::string line = text.ToCString();
    if (std::find(kept.begin(), kept.end(), line) == kept.end()) kept.push_back(line);
  }
};

}  // namespace

QuietSession::QuietSession() : lock_(library_mutex()), listener_(new Listener) {
  const Handle(Message_Messenger)& messenger = Message::DefaultMessenger();
  printers_ = messenger->Printers();
  messenger->ChangePrinters().Clear();
  messenger->AddPrinter(listener_);
}

QuietSession::~QuietSession() {
  Message::DefaultMessenger()->ChangePrinters() = printers_;
}

std::string QuietSession::said() const {
  constexpr size_t kMostLines = 3;
  std::string all;
  const auto& lines = static_cast<const Listener*>(listener_.get())->lines;
  for (size_t i = 0; i < std::min(kMostLines, lines.size()); ++i) all += (i > 0 ? "; " : "") + lines[i];
  return all;
}

void guarded(const std::string& path, const std::function<void()>& work) {
  try {
    work();
  } catch (const Standard_Failure& failure) {
    const char* const text = failure.GetMessageString();
    throw InputError("cad-unreadable", {path},
                     std::string("the file cannot be taken: ") + failure.DynamicType()->Name() +
                         (text != nullptr && *text != '\0' ? std::string(", ") + text : ""),
                     "export the part again as STEP AP214 or AP242");
  }
}

std::string check_cad_file(const std::string& path) {
  const char* const fix = "give a STEP (.stp, .step) or IGES (.igs, .iges) file";
  refuse_special_file(path);
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (error) throw InputError("cad-unreadable", {path}, "the file cannot be read: " + error.message(), fix);
  if (size == 0) throw InputError("cad-unreadable", {path}, "the file is empty", fix);
  if (size > (uint64_t{1} << 30U))
    throw InputError("cad-unreadable", {path}, "the file is larger than 1 GB", "export the part alone");
  std::ifstream file(path, std::ios::binary);
  std::string start(200, '\0');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<size_t>(file.gcount()));
  return start;
}

}  // namespace swarf::brep
