// SPDX-License-Identifier: Apache-2.0
// Reading and answering of requests of any kind.
#pragma once

#include <cstdint>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <utility>

#include "converters/base/error.h"
#include "viewer/session/document/arguments.h"
#include "viewer/session/session.h"

// after Eigen, which the macros of <resolv.h> break
#include <httplib.h>

namespace lumen::viewer {

constexpr const char* kBytes = "application/octet-stream";
constexpr const char* kJson = "application/json";

/// Headers of every answer. The page may run its own script and libblob, and talk to this server.
httplib::Headers safeHeaders();

/// Answers with these bytes uncompressed. httplib compresses an answer that it gets whole, which
/// takes seconds for the page's script and saves nothing on the loopback interface.
void answerBytes(httplib::Response& response, std::shared_ptr<const std::string> bytes,
                 const char* type);
void answerText(httplib::Response& response, std::string text, const char* type = kJson);
/// A sentence in JSON.
void answerError(httplib::Response& response, int status, const std::string& sentence);
/// A part of the document; 304 if the page has it, 404 without a body if there is none.
void answerPart(const httplib::Request& request, httplib::Response& response, const Tagged& part);

/// The status of a request that ended in an error of that kind.
int statusOf(ErrorKind kind);

/// Runs the answer to a request; an exception becomes an answer in JSON.
template <class Answer>
void guarded(httplib::Response& response, Answer&& answer) {
  try {
    answer();
  } catch (const Conflict& conflict) {
    answerError(response, 409, conflict.what());
  } catch (const Error& error) {
    answerError(response, statusOf(error.kind()), error.what());
  } catch (const std::bad_alloc&) {
    answerError(response, 500, "there is not enough memory");
  } catch (const std::exception& error) {
    answerError(response, 500, std::string("unexpected: ") + error.what());
  }
}

/// Throws Error(Usage): the body has more bytes.
[[noreturn]] void refuseSize(std::uint64_t most);

/// The body, of at most `most` bytes. Throws Error(Usage) for a longer one, a form in several parts,
/// and one that breaks off.
std::string bodyOf(const httplib::Request& request, const httplib::ContentReader& reader,
                   std::uint64_t most);

/// A body in JSON, of at most 1 MiB.
formats::JsonDocument readJson(const httplib::Request& request,
                               const httplib::ContentReader& reader);

}  // namespace lumen::viewer
