// SPDX-License-Identifier: Apache-2.0
// The passes that remeshing repeats over a piece.
#pragma once

#include "converters/stages/surface/remesh/remesh_mesh.h"

namespace lumen::convert {

/// Splits edges longer than 4/3 of their target, except those of the boundary.
void splitLong(RemeshMesh& mesh);

/// Collapses edges shorter than 4/5 of their target, where no edge longer than 4/3 of its target
/// is made and no face turns.
void collapseShort(RemeshMesh& mesh);

/// Flips edges where that brings valences nearer to six.
void flipToSix(RemeshMesh& mesh);

/// Flips edges where that makes the lesser of the least angles of both faces larger.
void flipForAngles(RemeshMesh& mesh);

/// Moves vertices along the surface towards the middle of their faces, weighted so that areas of
/// faces follow their targets; those of a rim towards the middle of their neighbours on it.
void relax(RemeshMesh& mesh);

/// Moves vertices that may have left the field's surface onto it: by one step of Newton's method,
/// or, with `exactly`, all of them and to within SeparatedField::project()'s tolerance.
void moveOntoField(RemeshMesh& mesh, bool exactly);

/// Moves one vertex onto the field as exactly as project() does; false if nothing is near by.
bool settle(RemeshMesh& mesh, RemeshMesh::VertexHandle vertex);

/// Lowers targets, to a fifth at most, where a slit runs between two vessels and the middle of an
/// edge is out of the surface by more than a quarter of the gap.
void refineSlits(RemeshMesh& mesh);

/// Repairs sharp and folded faces until there are none or nothing helps.
void mendFaces(RemeshMesh& mesh, const Progress& progress);

/// Repairs faces that mendFaces() has left: takes the wall around them off the field, and stretches
/// it.
void stretchFolds(RemeshMesh& mesh, const Progress& progress);

}  // namespace lumen::convert
