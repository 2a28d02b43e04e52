// A labelled shape, or the error that took its place, through a pair of files: what the helper process hands to its
// parent; and a labelled shape as bytes.
#pragma once

#include <string>

#include "base/error.h"
#include "cad/body.h"

namespace curvetet {

/// A number from which strtod makes the same to the last bit.
std::string exact_text(double x);

/// Writes the first line of the label file, by which the parent knows that the program is a helper of its own version.
bool announce_transfer(const std::string& out_path);
/// Writes the shape to out_path and its labels to out_path + ".labels". False if a file cannot be written.
bool write_transfer(const CadBody& body, const std::string& out_path);
bool write_transfer(const Error& error, const std::string& out_path);

/// Has the helper announced itself?
bool transfer_announced(const std::string& out_path);
/// What was written: the body, or the helper's error. An incomplete pair of files is an error of kind reader_crashed.
Result<CadBody> read_transfer(const std::string& out_path);

/// The body as bytes, from which unpack makes the same body to the last bit. Bytes that are not from pack, or of
/// another version, are an error (file_unreadable); damage is to be ruled out before, since OpenCASCADE trusts what it
/// reads.
Result<std::string> pack(const CadBody& body);
Result<CadBody> unpack(const std::string& bytes);

}  // namespace curvetet
