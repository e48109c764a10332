// SPDX-License-Identifier: Apache-2.0
// Arrays of VTK's XML files: compressed by zlib and base64-coded inline, which every VTK from 5 on
// reads.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace lumen::convert {

/// <DataArray ATTRIBUTES>. Throws Error(Failed) if zlib refuses.
std::string vtkElement(const std::string& attributes, std::span<const std::byte> data);

/// Numbers of one of VTK's types, such as "Float32" for float.
template <class T>
std::string dataArray(const std::string& type, const std::string& name, std::size_t components,
                      const std::vector<T>& values) {
  return vtkElement("type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
                        std::to_string(components) + "\"",
                    std::as_bytes(std::span(values)));
}

/// Texts; zeros within them become spaces.
std::string textArray(const std::string& name, const std::vector<std::string>& texts);

}  // namespace lumen::convert
