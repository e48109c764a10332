// SPDX-License-Identifier: Apache-2.0
// Names of options that messages of several rooms mention, where these advise on a command line. A row
// takes its name from here, too, so that a rename is a change of one line. Messages about the fields
// of an operation's own options use their word (base/field_word.h).
#pragma once

#include <string>

namespace lumen {

/// The name of an option, as its row has it.
struct OptionName {
  const char* name;  ///< without dashes: "crop"

  /// The name as people write it: "--crop".
  [[nodiscard]] std::string shown() const { return std::string("--") + name; }
};

/// Options that messages mention. Every member is an OptionName, so a test can walk them and
/// find each in the table of a command. A row of an equal name with another meaning, such as `unit`
/// of lumen export, keeps a literal of its own.
struct OptionNames {
  // all commands
  OptionName json{"json"};
  // volumes, meshes and centerlines that are read
  OptionName unit{"unit"};
  OptionName frame{"frame"};
  OptionName volumeIndex{"volume-index"};
  OptionName crop{"crop"};
  OptionName volume{"volume"};
  // seeds and tracking
  OptionName root{"root"};
  OptionName seeds{"seeds"};
  OptionName dark{"dark"};
  // pictures, and meshes that are written
  OptionName colour{"colour"};
  // lumen motion
  OptionName period{"period"};
  OptionName times{"times"};
  OptionName frames{"frames"};
  // lumen validate
  OptionName privacy{"privacy"};
  // libraries
  OptionName id{"id"};
  OptionName replace{"replace"};
  OptionName licence{"licence"};
  OptionName consent{"consent"};
  OptionName deidentification{"deidentification"};
  OptionName synthetic{"synthetic"};
  OptionName resume{"resume"};
  OptionName key{"key"};
  OptionName state{"state"};
};

inline constexpr OptionNames kOption{};

}  // namespace lumen
