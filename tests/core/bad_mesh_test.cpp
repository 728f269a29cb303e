// Files that no part can be made of: each must end in one readable line that starts with the file's name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/error.hpp"
#include "core/mesh_io.hpp"
#include "core/random.hpp"
#include "mesh_samples.hpp"
#include "temp_folder.hpp"

namespace binpick {
namespace {

using samples::with;
using samples::with_float;
using samples::with_u32;
using testing::HasSubstr;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::size_t kFirstCorner = 84 + 12;  // of a binary STL: header, count, normal

struct BadFile {
  std::string name;  // of the case
  std::string file;  // its extension chooses the reader
  std::string bytes;
  std::string says;  // part of the message
  std::string unit = "";
};

void PrintTo(const BadFile& bad, std::ostream* out) { *out << bad.name; }

std::string head(const std::string& text, std::size_t size) { return text.substr(0, size); }

std::vector<BadFile> bad_stl() {
  const std::string binary = samples::binary_stl();
  const std::string text = samples::ascii_stl();
  const std::string line = "vertex 40 40 40";
  return {
      {"StlEmpty", "a.stl", "", "empty"},
      {"StlOneByte", "a.stl", "s", "too few"},
      {"StlBlanks", "a.stl", std::string(200, ' '), "claims"},
      {"StlBinaryHeaderOnly", "a.stl", head(binary, 80), "too few"},
      {"StlBinaryCutInTheCount", "a.stl", head(binary, 82), "too few"},
      {"StlBinaryCutInATriangle", "a.stl", head(binary, 84 + 50 * 5 + 17), "claims 12 triangles"},
      {"StlBinaryCutBetweenTriangles", "a.stl", head(binary, 84 + 50 * 11), "claims 12 triangles"},
      {"StlBinaryOneByteMore", "a.stl", binary + "x", "claims 12 triangles"},
      {"StlBinaryZeroTriangles", "a.stl", with_u32(head(binary, 84), 80, 0), "no triangles"},
      {"StlBinaryClaimsMore", "a.stl", with_u32(binary, 80, 13), "claims 13 triangles"},
      {"StlBinaryClaimsFewer", "a.stl", with_u32(binary, 80, 11), "claims 11 triangles"},
      {"StlBinaryClaimsFourBillion", "a.stl", with_u32(binary, 80, 0xffffffffu), "4294967295 triangles"},
      {"StlBinaryCountWrapsIn32Bits", "a.stl", with_u32(binary, 80, 12 + 0x80000000u), "2147483660 triangles"},
      {"StlBinaryNan", "a.stl", with_float(binary, kFirstCorner, kNan), "not a finite number"},
      {"StlBinaryInfinity", "a.stl", with_float(binary, kFirstCorner + 4, kInfinity), "not a finite number"},
      {"StlBinaryHuge", "a.stl", with_float(binary, kFirstCorner + 8, 1e38f), "beyond"},
      {"StlBinaryInMetres", "a.stl", samples::binary_stl(1), "`unit: m`"},
      {"StlBinaryInMicrometres", "a.stl", samples::binary_stl(1e6), "outside 1 mm .. 2000 mm"},
      {"StlBinaryInMillimetresAsMetres", "a.stl", binary, "`unit: mm`", "m"},
      {"StlUnknownUnit", "a.stl", binary, "unit 'furlong' is not known", "furlong"},
      {"StlAsciiCutInAFacet", "a.stl", head(text, text.find("endloop", text.size() / 2)), "the file ends"},
      {"StlAsciiWithoutEndsolid", "a.stl", with(text, "endsolid block\n", ""), "endsolid"},
      {"StlAsciiNothingInside", "a.stl", "solid block\nendsolid block\n", "no triangles"},
      {"StlAsciiNan", "a.stl", with(text, line, "vertex nan 40 40"), "'nan' is not a finite number"},
      {"StlAsciiInfinity", "a.stl", with(text, line, "vertex 40 inf 40"), "'inf' is not a finite number"},
      {"StlAsciiHuge", "a.stl", with(text, line, "vertex 40 1e38 40"), "beyond"},
      {"StlAsciiOverflow", "a.stl", with(text, line, "vertex 40 1e999 40"), "'1e999' is out of range"},
      {"StlAsciiDecimalComma", "a.stl", with(text, line, "vertex 40,0 40,0 40,0"), "decimal comma"},
      {"StlAsciiWord", "a.stl", with(text, line, "vertex 40 forty 40"), "'forty' is not a number"},
      {"StlAsciiHexadecimal", "a.stl", with(text, line, "vertex 0x28 40 40"), "'0x28' is not a number"},
      {"StlAsciiTwoCoordinates", "a.stl", with(text, line, "vertex 40 40"), "found 2 words"},
      {"StlAsciiTwoCorners", "a.stl", with(text, "      " + line + "\n", ""), "'vertex' expected"},
      {"StlAsciiFourCorners", "a.stl", with(text, line, line + "\n" + line), "'endloop' expected"},
      {"StlAsciiZeroAreaOnly", "a.stl",
       "solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 50 0 0\nvertex 100 0 0\nendloop\nendfacet\n"
       "endsolid a\n",
       "zero area"},
      {"StlFarFromItsOrigin", "a.stl",  // 10 m from a triangle of 71 mm
       "solid a\nfacet normal 0 0 0\nouter loop\nvertex 10000 0 0\nvertex 10050 0 0\nvertex 10050 50 0\nendloop\n"
       "endfacet\nendsolid a\n",
       "from its origin"},
      {"StlIsAPicture", "a.stl", "\x89PNG\r\n\x1a\n" + std::string(300, '\x7f'), "claims"},
  };
}

std::vector<BadFile> bad_obj() {
  const std::string text = samples::obj();
  const std::string vertex = "v " + samples::mm(samples::block().vertices[0]);
  const std::string face = "f 1 ";
  std::string many;
  for (int i = 0; i < 5001; ++i) many += " 1 2";
  std::string objects;
  for (int i = 0; i < 20000; ++i) objects += "o a\n";
  return {
      {"ObjEmpty", "a.obj", "", "empty"},
      {"ObjWithoutFaces", "a.obj", head(text, text.find("f ")), "no faces"},
      {"ObjIndexTooLarge", "a.obj", text + "f 1 2 9\n", "vertex 9 does not exist, the file has 8"},
      {"ObjIndexZero", "a.obj", text + "f 0 1 2\n", "vertex '0' does not exist"},
      {"ObjIndexTooNegative", "a.obj", text + "f 1 2 -9\n", "vertex '-9' does not exist"},
      {"ObjIndexOverflow", "a.obj", text + "f 1 2 99999999999999999999\n", "not a whole number"},
      {"ObjIndexIsReal", "a.obj", text + "f 1 2 3.5\n", "not a whole number"},
      {"ObjFaceOfTwo", "a.obj", text + "f 1 2\n", "three corners"},
      {"ObjNan", "a.obj", with(text, vertex, "v nan 0 0"), "not a finite number"},
      {"ObjOverflow", "a.obj", with(text, vertex, "v 1e999 0 0"), "out of range"},
      {"ObjHuge", "a.obj", with(text, vertex, "v 1e38 0 0"), "beyond"},
      {"ObjDecimalComma", "a.obj", with(text, vertex, "v 0,5 0,5 0,5"), "decimal comma"},
      {"ObjCutInAVertex", "a.obj", head(text, text.find(vertex) + 4), "'v x y z' expected"},
      {"ObjFreeForm", "a.obj", text + "curv 0 1 1 2 3\n", "'curv' is not read"},
      {"ObjTooManyObjects", "a.obj", text + objects, "more than 20000 objects"},
      {"ObjFaceOfTooMany", "a.obj", text + "f" + many + "\n", "a face with more than 10000 corners"},
      {"ObjBinary", "a.obj", std::string(64, '\0') + std::string(64, '\xff'), "is not read"},
      {"ObjInMetres", "a.obj", "v 0 0 0\nv 0.05 0 0\nv 0 0.05 0\nv 0 0 0.05\nf 1 2 3\nf 1 2 4\nf 1 3 4\n", "`unit: m`"},
  };
}

std::vector<BadFile> bad_ply() {
  const std::string text = samples::ascii_ply();
  const std::string little = samples::binary_ply(false);
  const std::size_t data = little.find("end_header\n") + 11;
  const std::string first = "end_header\n" + samples::mm(samples::block().vertices[0]);
  const auto first_is = [&](const std::string& line) { return with(text, first, "end_header\n" + line); };
  return {
      {"PlyEmpty", "a.ply", "", "empty"},
      {"PlyOtherMagic", "a.ply", "plx\n" + text, "does not start with 'ply'"},
      {"PlyHeaderCut", "a.ply", head(text, 60), "PLY header"},
      {"PlyUnknownFormat", "a.ply", with(text, "ascii", "utf8"), "'utf8' is not a PLY format"},
      {"PlyUnknownType", "a.ply", with(text, "float x", "quad x"), "'quad' is not a PLY type"},
      {"PlyWithoutZ", "a.ply", with(text, "property float z\n", ""), "lack x, y or z"},
      {"PlyCoordinateTwice", "a.ply", with(text, "float z", "float x"), "lack x, y or z"},
      {"PlyTwoListsOfVertices", "a.ply",
       with(text, "element face 12",
            "element vertex 0\nproperty int x\nproperty int y\nproperty int z\nelement face 12"),
       "must hold one list of vertices"},
      {"PlyWithoutFaces", "a.ply", head(with(text, "face 12", "face 0"), text.size() / 2), "no faces"},
      {"PlyNegativeCount", "a.ply", with(text, "vertex 8", "vertex -8"), "beyond"},
      {"PlyHugeCount", "a.ply", with(text, "vertex 8", "vertex 4000000000"), "beyond"},
      {"PlyOverflowingCount", "a.ply", with(text, "vertex 8", "vertex 18446744073709551624"), "not a whole number"},
      {"PlyClaimsMoreVertices", "a.ply", with(text, "vertex 8", "vertex 9"), "one value too many"},
      {"PlyClaimsFewerVertices", "a.ply", with(text, "vertex 8", "vertex 7"), ""},
      {"PlyClaimsMoreFaces", "a.ply", with(text, "face 12", "face 13"), "the file ends"},
      {"PlyClaimsFewerFaces", "a.ply", with(text, "face 12", "face 11"), "more lines"},
      {"PlyIndexOutOfRange", "a.ply", with(text, "\n3 ", "\n3 8"), "does not exist"},
      {"PlyNegativeIndex", "a.ply", with(text, "\n3 ", "\n3 -1 "), "does not exist"},
      {"PlyFaceOfTwo", "a.ply", with(text, "\n3 ", "\n2 "), "fewer than three"},
      {"PlyFaceOfTooMany", "a.ply", with(text, "\n3 ", "\n10001 "), "a face with more than 10000 corners"},
      {"PlyNan", "a.ply", first_is("nan 0 0"), "not a finite number"},
      {"PlyHuge", "a.ply", first_is("0 1e38 0"), "beyond"},
      {"PlyDecimalComma", "a.ply", first_is("0,5 0,5 0,5"), "decimal comma"},
      {"PlyValueMissing", "a.ply", first_is("0 0"), "a value is missing"},
      {"PlyBinaryCut", "a.ply", head(little, little.size() - 1), "the file ends"},
      {"PlyBinaryCutAfterTheHeader", "a.ply", head(little, data), "the file ends"},
      {"PlyBinaryOneByteMore", "a.ply", little + "x", "more bytes"},
      {"PlyBinaryNan", "a.ply", with_float(little, data, kNan), "not a finite number"},
      {"PlyBinaryIndex", "a.ply", with_u32(little, data + 8 * 12 + 1, 0x7fffffffu), "does not exist"},
      {"PlyListCountedByAReal", "a.ply", with(text, "list uchar int", "list float int"), "counted by a real"},
  };
}

std::vector<BadFile> bad_other() {
  return {
      {"UnknownExtension", "a.fbx", "anything", "files '.fbx' are not read"},
      {"NoExtension", "block", samples::ascii_stl(), "are not read"},
      {"ObjNamedStl", "a.stl", samples::obj(), "claims"},
      {"StlNamedObj", "a.obj", samples::ascii_stl(), "statement 'solid' is not read"},
      {"StlNamedPly", "a.ply", samples::ascii_stl(), "does not start with 'ply'"},
      {"StlNamedStep", "a.step", samples::ascii_stl(), "STEP file"},
  };
}

class BadMesh : public testing::TestWithParam<BadFile> {};

TEST_P(BadMesh, IsRefusedInOneLineThatNamesTheFile) {
  const BadFile& bad = GetParam();
  const TempFolder folder;
  const std::string path = folder.put(bad.file, bad.bytes);
  try {
    read_mesh(path, {bad.unit, 1e-4});
    FAIL() << "accepted";
  } catch (const AssetError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.rfind(path, 0), 0u) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_LT(message.size(), path.size() + 200) << message;
    EXPECT_THAT(message, HasSubstr(bad.says));
  }
}

std::string case_name(const testing::TestParamInfo<BadFile>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Stl, BadMesh, testing::ValuesIn(bad_stl()), case_name);
INSTANTIATE_TEST_SUITE_P(Obj, BadMesh, testing::ValuesIn(bad_obj()), case_name);
INSTANTIATE_TEST_SUITE_P(Ply, BadMesh, testing::ValuesIn(bad_ply()), case_name);
INSTANTIATE_TEST_SUITE_P(Other, BadMesh, testing::ValuesIn(bad_other()), case_name);

TEST(BadMesh, MissingFilesAndFolders) {
  const TempFolder folder;
  std::filesystem::create_directories(folder.at("folder.stl"));
  for (const char* name : {"missing.stl", "missing.obj", "missing.ply", "missing.step", "folder.stl"}) {
    EXPECT_THROW(read_mesh(folder.at(name)), AssetError) << name;
  }
  EXPECT_THROW(read_mesh(""), AssetError);
  EXPECT_THROW(read_mesh("/dev/zero"), AssetError);
}

TEST(BadMesh, TooManyTrianglesAreRefusedFromTheHeader) {
  // A sparse file of the true size for eleven million triangles: refused before the bytes are turned into anything.
  const TempFolder folder;
  const std::string path = folder.put("a.stl", with_u32(std::string(84, ' '), 80, 11'000'000));
  std::filesystem::resize_file(path, 84 + 50ull * 11'000'000);
  try {
    read_mesh(path);
    FAIL() << "accepted";
  } catch (const AssetError& error) {
    EXPECT_THAT(error.what(), HasSubstr("11000000 triangles are more than the 10000000 allowed"));
  }
}

// Every prefix of a file and every single damaged byte must be refused or give a mesh; nothing else.
TEST(BadMesh, AnyTruncationAndAnyFlippedByteIsSurvived) {
  const TempFolder folder;
  const std::vector<std::pair<std::string, std::string>> files = {{"a.stl", samples::binary_stl()},
                                                                  {"b.stl", samples::ascii_stl()},
                                                                  {"a.obj", samples::obj()},
                                                                  {"a.ply", samples::ascii_ply()},
                                                                  {"b.ply", samples::binary_ply(true)}};
  int refused = 0;
  for (const auto& [name, bytes] : files) {
    const auto survive = [&](const std::string& spoilt) {
      const std::string path = folder.put(name, spoilt);
      try {
        EXPECT_FALSE(read_mesh(path).empty());
      } catch (const AssetError&) {
        ++refused;
      }
    };
    Rng rng = Seed{1}.child(name).rng();
    for (int i = 0; i < 60; ++i) {
      survive(bytes.substr(0, rng.below(bytes.size())));
      std::string flipped = bytes;
      flipped[rng.below(bytes.size())] ^= static_cast<char>(1u << rng.below(8));
      survive(flipped);
    }
  }
  EXPECT_GT(refused, 200);
}

}  // namespace
}  // namespace binpick
