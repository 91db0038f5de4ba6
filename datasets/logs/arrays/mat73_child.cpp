#include "datasets/logs/arrays/mat73_child.hpp"

#include <unistd.h>

#ifdef ODOBENCH_MATIO

#include <fcntl.h>
#include <matio.h>
#include <sys/resource.h>

#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <string>

namespace odobench {
namespace {

constexpr int kDeepestLevel = 16;
constexpr rlim_t kMostMemory = rlim_t{2} << 30, kMostSeconds = 60;

class Pipe {
 public:
  explicit Pipe(int descriptor) : descriptor_(descriptor) {}

  void bytes(const void* from, std::size_t count) {
    const char* at = static_cast<const char*>(from);
    while (count > 0) {
      const ssize_t n = ::write(descriptor_, at, count);
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) ::_exit(1);  // nobody listens
      at += n;
      count -= static_cast<std::size_t>(n);
    }
  }
  template <class T>
  void value(T number) {
    bytes(&number, sizeof number);
  }
  void text(const std::string& text) {
    value(static_cast<std::uint32_t>(text.size()));
    bytes(text.data(), text.size());
  }
  void message(Mat73Message kind) { value(static_cast<unsigned char>(kind)); }

 private:
  int descriptor_;
};

void send(Pipe& pipe, matvar_t* variable, const std::string& name, int level);

void send_struct(Pipe& pipe, matvar_t* variable, const std::string& name, int level) {
  std::size_t count = 1;
  for (int k = 0; k < variable->rank; ++k) count *= variable->dims[k];
  const unsigned fields = Mat_VarGetNumberOfFields(variable);
  char* const* names = Mat_VarGetStructFieldnames(variable);
  for (std::size_t i = 0; i < count; ++i)
    for (unsigned f = 0; f < fields; ++f) {
      matvar_t* field = Mat_VarGetStructFieldByIndex(variable, f, i);
      const std::string element = count == 1 ? "" : "[" + std::to_string(i) + "]";
      if (field != nullptr) send(pipe, field, name + element + "." + names[f], level + 1);
    }
}

void skip(Pipe& pipe, const std::string& name, const std::string& reason) {
  pipe.message(Mat73Message::Skip);
  pipe.text(name);
  pipe.text(reason);
}

void send(Pipe& pipe, matvar_t* variable, const std::string& name, int level) {
  const bool number = variable->class_type >= MAT_C_DOUBLE && variable->class_type <= MAT_C_UINT64;
  if (level > kDeepestLevel) return skip(pipe, name, "structs are nested too deep");
  if (variable->class_type == MAT_C_STRUCT) return send_struct(pipe, variable, name, level);
  if (!number || variable->isComplex != 0)
    return skip(pipe, name, number ? "complex numbers, expected real ones" : "no array of numbers");
  const std::size_t size = Mat_SizeOfClass(variable->class_type);
  std::uint64_t count = 1;
  for (int k = 0; k < variable->rank; ++k) count *= variable->dims[k];
  if (variable->data == nullptr && count > 0) return skip(pipe, name, "its numbers cannot be read");
  if (variable->nbytes < count * size) return skip(pipe, name, "its numbers are missing");
  pipe.message(Mat73Message::Array);
  pipe.text(name);
  pipe.value(static_cast<unsigned char>(variable->class_type + (variable->isLogical != 0 ? 128 : 0)));
  pipe.value(static_cast<std::uint32_t>(variable->rank));
  for (int k = 0; k < variable->rank; ++k) pipe.value(static_cast<std::uint64_t>(variable->dims[k]));
  pipe.value(count * size);
  pipe.bytes(variable->data, static_cast<std::size_t>(count * size));
}

void limit_child() {
  const rlimit seconds{kMostSeconds, kMostSeconds}, no_core{0, 0};
  ::setrlimit(RLIMIT_CPU, &seconds);
  ::setrlimit(RLIMIT_CORE, &no_core);
#if !defined(__SANITIZE_ADDRESS__)  // whose shadow memory alone is larger
  const rlimit memory{kMostMemory, kMostMemory};
  ::setrlimit(RLIMIT_AS, &memory);
#endif
  const int nowhere = ::open("/dev/null", O_RDWR);  // HDF5 says on standard error what it thinks of the file
  for (const int descriptor : {0, 1, 2})
    if (nowhere >= 0) ::dup2(nowhere, descriptor);
}

}  // namespace

bool has_matio() {
  return true;
}

void read_mat73_in_child(const std::filesystem::path& file, int descriptor) {
  limit_child();
  Pipe pipe(descriptor);
  mat_t* mat = Mat_Open(file.c_str(), MAT_ACC_RDONLY);
  if (mat == nullptr) {
    pipe.message(Mat73Message::Fault);
    pipe.text("");
    pipe.text("libmatio cannot open it: it is damaged or cut off");
    ::_exit(0);
  }
  while (matvar_t* variable = Mat_VarReadNextInfo(mat)) {
    const std::string name = variable->name == nullptr ? "" : variable->name;
    if (!name.empty() && name[0] != '#') {  // MATLAB's own data: #refs#, #subsystem#
      if (Mat_VarReadDataAll(mat, variable) == 0)
        send(pipe, variable, name, 0);
      else
        skip(pipe, name, "its numbers cannot be read");
    }
    Mat_VarFree(variable);
  }
  pipe.message(Mat73Message::End);
  ::_exit(0);
}

}  // namespace odobench

#else

namespace odobench {

bool has_matio() {
  return false;
}

void read_mat73_in_child(const std::filesystem::path&, int) {
  ::_exit(1);
}

}  // namespace odobench

#endif
