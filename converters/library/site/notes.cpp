// SPDX-License-Identifier: Apache-2.0
#include "converters/library/site/notes.h"

#include "converters/base/html.h"
#include "converters/base/option_name.h"

namespace lumen::convert {

namespace {

/// Command that verifies this signature without lumen.
std::string plainCommand(const std::string& signature) {
  if (signature.ends_with(".minisig")) return "minisign -V -p PUBLISHER.pub -m library.json\n";
  if (signature.ends_with(".sig"))
    return "ssh-keygen -Y verify -f ALLOWED_SIGNERS -I PUBLISHER -n lumen-library \\\n"
           "  -s library.json.sig < library.json\n";
  return {};
}

}  // namespace

std::string copyable(const std::string& name, const std::string& text) {
  std::string block = "<div class=\"copy\" data-name=\"";
  block += htmlText(name);
  block += "\"><pre tabindex=\"0\">";
  for (std::size_t at = 0; at < text.size();) {  // lines stay lines; all else as htmlText() has it
    const std::size_t end = text.find('\n', at);
    block += htmlText(std::string_view(text).substr(at, end - at));
    block += '\n';
    at = end == std::string::npos ? text.size() : end + 1;
  }
  block += "</pre></div>\n";
  return block;
}

std::string howToVerify(const LibraryFile& library, const std::string& root,
                        const std::string& signature) {
  std::string text = "<p>";
  if (signature.empty())
    text +=
        "When this page was made, <strong>no signature</strong> (<code>library.json.minisig</code> "
        "or <code>library.json.sig</code>) lay beside <code>library.json</code>. Without one, "
        "digests show damage, but not who published what they belong to.";
  else
    text +=
        "A signature, <a href=\"" + root + urlAddress(signature) + "\"><code>" +
        htmlText(signature) +
        "</code></a>, lay beside <code>library.json</code> when this page was made. "
        "<strong>This page has not verified it, and cannot</strong>: who changes a file can change "
        "the page.";
  text +=
      " With the whole library on your disk and a key of the publisher that you got elsewhere, "
      "this "
      "verifies every byte:</p>\n";
  text +=
      copyable("the commands that verify", "lumen library verify . " + kOption.key.shown() +
                                               " PUBLISHER.pub   # in the folder of the library\n" +
                                               plainCommand(signature));
  text += "<p class=\"quiet\">Library " + htmlText(library.id) + ", revision " +
          std::to_string(library.revision) + " of " + htmlText(library.date) + ".</p>\n";
  return text;
}

std::string footer(const LibraryFile& library, const std::string& root,
                   const std::string& signature) {
  std::string text = "<footer class=\"end\">\n<details>\n<summary>Can it be trusted?</summary>\n";
  text += howToVerify(library, root, signature);
  text += "</details>\n<p class=\"quiet\">";
  if (!root.empty()) text += "<a href=\"" + root + "index.html\">All cases</a> · ";
  text += "<a href=\"" + root + "library.json\">library.json</a> · a BagIt bag with an <a href=\"" +
          root + "data/ro-crate-metadata.json\">RO-Crate</a> · made by " +
          htmlText(library.generator) + " · not for clinical use</p>\n</footer>\n";
  return text;
}

}  // namespace lumen::convert
