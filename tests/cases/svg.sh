# Words for pictures; read by the setup of skill-plot.

# svg [FILE]: refuses what is no well-formed SVG with finite numbers on its page; prints the size of the page, how many
# elements of each kind there are, and the words, each once, in their order.
svg() {
  [ $# -gt 0 ] || { cat >piped.svg; set -- piped.svg; }
  /usr/bin/python3 -B - "$1" <<'END'
import math, re, sys
import xml.etree.ElementTree as tree
root = tree.parse(sys.argv[1]).getroot()
space = "{http://www.w3.org/2000/svg}"
assert root.tag == space + "svg", root.tag
left, top, width, height = map(float, root.get("viewBox").split())
assert root.get("width") == "180mm" and abs(float(root.get("height")[:-2]) - height / 4) < 0.01
ground = root.find(space + "rect")
assert ground.get("fill") == "#ffffff" and float(ground.get("width")) == width
counts, words = {}, []
for element in root.iter():
    name = element.tag.replace(space, "")
    counts[name] = counts.get(name, 0) + 1
    for key in ("x", "y", "x1", "y1", "x2", "y2", "cx", "cy", "r", "width", "height", "font-size", "stroke-width"):
        if key in element.attrib and name != "svg":
            assert math.isfinite(float(element.get(key))), (name, key)
    for number in re.split("[ ,]", element.get("points", "0")):
        assert math.isfinite(float(number)), number
    if name == "text":
        assert 0 <= float(element.get("x")) <= width and 0 <= float(element.get("y")) <= height, element.text
        assert float(element.get("font-size")) >= 10
        if element.text not in words and not re.fullmatch("\u2212?[0-9.]+", element.text):
            words.append(element.text)
print("page %g x %g" % (width, height))
print(" ".join("%s %d" % (name, counts[name]) for name in ("polyline", "polygon", "circle") if name in counts))
print(" | ".join(words))
END
}
