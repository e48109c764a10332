// SPDX-License-Identifier: Apache-2.0
// Exceptions of the stages; `main` turns them into a message on standard error and an exit code.
#pragma once

#include <stdexcept>
#include <string>

namespace lumen {

/// Values are the process exit codes.
enum class ErrorKind : int {
  Failed = 1,
  Usage = 2,
  InvalidInput = 3,
  Unsupported = 4,
  Cancelled = 130
};

class Error : public std::runtime_error {
public:
  Error(ErrorKind kind, const std::string& what) : std::runtime_error(what), m_kind(kind) {}
  [[nodiscard]] ErrorKind kind() const { return m_kind; }

private:
  ErrorKind m_kind;
};

/// Bad input; `what` names the file, the place in it, the finding and the expectation.
inline Error invalidInput(const std::string& what) {
  return {ErrorKind::InvalidInput, what};
}
/// Legal input that this program does not handle.
inline Error unsupported(const std::string& what) {
  return {ErrorKind::Unsupported, what};
}
/// Any other failure, such as a full disk.
inline Error failed(const std::string& what) {
  return {ErrorKind::Failed, what};
}

}  // namespace lumen
