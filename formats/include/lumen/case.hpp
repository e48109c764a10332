// SPDX-License-Identifier: Apache-2.0
//
// Cases of lumen for C++17: lumen/case.h and lumen/case_edit.h with ownership and exceptions. All of
// it is inline, so it has no binary interface of its own. Units, frame, threads and the life of
// arrays and texts are those of lumen/case.h.
//
//     lumen::VesselCase head = lumen::VesselCase::open("head.lumen");   // throws lumen::CaseError
//     for (float radius : head.radii()) widest = std::max(widest, radius);
//     head.setLabel(head.findBranch("A.1"), "basilar");
//     head.save("named.lumen");
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "lumen/case.h"
#include "lumen/case_edit.h"

namespace lumen {

/// A status that is no success, with the fault that describes it.
class CaseError : public std::runtime_error {
public:
  CaseError(lumen_case_status status, const lumen_case_fault& fault)
      : std::runtime_error(fault.message[0] ? fault.message : lumen_case_status_text(status)),
        m_status(status),
        m_fault(fault) {}
  lumen_case_status status() const noexcept { return m_status; }
  /// The broken rule; its code is 0 if the error is about none.
  const lumen_case_fault& fault() const noexcept { return m_fault; }

private:
  lumen_case_status m_status;
  lumen_case_fault m_fault;
};

/// `count` values that belong to a case.
template <class T>
class CaseArray {
public:
  CaseArray(const T* first, std::size_t count) : m_first(first), m_count(count) {}
  const T* begin() const noexcept { return m_first; }
  const T* end() const noexcept { return m_first + m_count; }
  const T* data() const noexcept { return m_first; }
  std::size_t size() const noexcept { return m_count; }
  bool empty() const noexcept { return m_count == 0; }
  const T& operator[](std::size_t i) const { return m_first[i]; }

private:
  const T* m_first;
  std::size_t m_count;
};

/// A case that is owned. A copy is a case of its own. One that was moved from may only be assigned
/// to or destroyed.
class VesselCase {
public:
  using Position = float[3];

  /// A case without nodes.
  VesselCase() : m_case(make()) {}
  static VesselCase open(const std::string& path) {
    return VesselCase([&](lumen_case** out, lumen_case_fault* fault) {
      return lumen_case_open(path.c_str(), out, fault);
    });
  }
  static VesselCase fromBytes(const void* bytes, std::size_t size) {
    return VesselCase([&](lumen_case** out, lumen_case_fault* fault) {
      return lumen_case_open_bytes(bytes, size, out, fault);
    });
  }
  VesselCase(const VesselCase& other)
      : VesselCase([&](lumen_case** out, lumen_case_fault*) {
          return lumen_case_copy(other.get(), out);
        }) {}
  VesselCase(VesselCase&&) noexcept = default;
  VesselCase& operator=(VesselCase other) noexcept {
    m_case = std::move(other.m_case);
    return *this;
  }
  ~VesselCase() = default;

  /// The handle of the functions in C, which the object keeps.
  const lumen_case* get() const noexcept { return m_case.get(); }
  lumen_case* get() noexcept { return m_case.get(); }

  void save(const std::string& path,
            const lumen_case_write_def& def = lumen_case_write_def_default()) const {
    demand(
        [&](lumen_case_fault* fault) { return lumen_case_save(get(), path.c_str(), &def, fault); });
  }
  std::vector<unsigned char> encode(
      const lumen_case_write_def& def = lumen_case_write_def_default()) const {
    void* bytes = nullptr;
    std::size_t size = 0;
    demand([&](lumen_case_fault* fault) {
      return lumen_case_encode(get(), &def, &bytes, &size, fault);
    });
    const std::unique_ptr<void, void (*)(void*)> owner(bytes, lumen_case_free);
    const auto* first = static_cast<const unsigned char*>(bytes);
    return {first, first + size};
  }

  lumen_case_nodes nodes() const noexcept { return lumen_case_get_nodes(get()); }
  std::size_t nodeCount() const noexcept { return nodes().count; }
  CaseArray<Position> centres() const noexcept { return {nodes().centre, nodeCount()}; }  // mm
  CaseArray<float> radii() const noexcept { return {nodes().radius, nodeCount()}; }       // mm
  CaseArray<std::int32_t> parents() const noexcept { return {nodes().parent, nodeCount()}; }
  std::size_t branchCount() const noexcept { return lumen_case_branch_count(get()); }
  lumen_case_branch branch(std::size_t index) const noexcept {
    return lumen_case_get_branch(get(), index);
  }
  /// SIZE_MAX if no branch has the label.
  std::size_t findBranch(const std::string& label) const noexcept {
    return lumen_case_find_branch(get(), label.c_str());
  }
  lumen_case_points points() const noexcept { return lumen_case_get_points(get()); }
  lumen_case_models models() const noexcept { return lumen_case_get_models(get()); }
  lumen_case_motion motion() const noexcept { return lumen_case_get_motion(get()); }
  std::string note() const { return lumen_case_note(get()); }

  void setTree(const lumen_case_nodes& nodes, const std::vector<lumen_case_branch>& branches) {
    demand([&](lumen_case_fault* fault) {
      return lumen_case_set_tree(get(), &nodes, branches.data(), branches.size(), fault);
    });
  }
  void appendBranch(const std::string& label, std::int32_t parentNode, std::size_t count,
                    const Position* centres, const float* radii,
                    lumen_case_kind kind = LUMEN_CASE_VESSEL) {
    demand([&](lumen_case_fault* fault) {
      return lumen_case_append_branch(get(), label.c_str(), kind, parentNode, count, centres, radii,
                                      fault);
    });
  }
  void removeBranch(std::size_t branch) {
    demand([&](lumen_case_fault* fault) { return lumen_case_remove_branch(get(), branch, fault); });
  }
  void setLabel(std::size_t branch, const std::string& label) {
    demand([&](lumen_case_fault* fault) {
      return lumen_case_set_label(get(), branch, label.c_str(), fault);
    });
  }
  void setNode(std::size_t node, const Position& centre, float radius) {
    demand([&](lumen_case_fault* fault) {
      return lumen_case_set_node(get(), node, centre, radius, fault);
    });
  }
  /// Null removes the motion.
  void setMotion(const lumen_case_motion* motion) {
    demand([&](lumen_case_fault* fault) { return lumen_case_set_motion(get(), motion, fault); });
  }
  void setNote(const std::string& note) {
    demand(
        [&](lumen_case_fault* fault) { return lumen_case_set_note(get(), note.c_str(), fault); });
  }

private:
  struct Close {
    void operator()(lumen_case* value) const noexcept { lumen_case_close(value); }
  };

  template <class Make>
  explicit VesselCase(Make make) {
    lumen_case* made = nullptr;
    demand([&](lumen_case_fault* fault) { return make(&made, fault); });
    m_case.reset(made);
  }
  static lumen_case* make() {
    lumen_case* made = nullptr;
    demand([&](lumen_case_fault*) { return lumen_case_create(&made); });
    return made;
  }
  template <class Call>
  static void demand(Call call) {
    lumen_case_fault fault{};
    if (const lumen_case_status status = call(&fault); status != LUMEN_CASE_OK)
      throw CaseError(status, fault);
  }

  std::unique_ptr<lumen_case, Close> m_case;
};

}  // namespace lumen
