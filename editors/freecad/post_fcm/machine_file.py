"""A machine file of `post`: its tables, its expressions, and what `post check` derives of it."""

import ast
import json
import math
import operator
import subprocess
import sys
import tempfile
from pathlib import Path

from . import Refused

BINARY = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
}
DEGREES = {
    "sin": lambda x: math.sin(math.radians(x)),
    "cos": lambda x: math.cos(math.radians(x)),
    "tan": lambda x: math.tan(math.radians(x)),
    "asin": lambda x: math.degrees(math.asin(x)),
    "acos": lambda x: math.degrees(math.acos(x)),
    "atan": lambda x: math.degrees(math.atan(x)),
    "atan2": lambda y, x: math.degrees(math.atan2(y, x)),
    "sqrt": math.sqrt,
    "abs": abs,
    "min": min,
    "max": max,
}


def value_of(given, parameters):
    """A number of a machine file, or an expression of its parameters."""
    if isinstance(given, (int, float)):
        return float(given)

    def of(node):
        if isinstance(node, ast.Constant) and isinstance(node.value, (int, float)):
            return float(node.value)
        if isinstance(node, ast.Name):
            return math.pi if node.id == "pi" else value_of(parameters[node.id], parameters)
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.USub, ast.UAdd)):
            return of(node.operand) * (-1 if isinstance(node.op, ast.USub) else 1)
        if isinstance(node, ast.BinOp) and type(node.op) in BINARY:
            return BINARY[type(node.op)](of(node.left), of(node.right))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in DEGREES:
            return DEGREES[node.func.id](*map(of, node.args))
        raise KeyError(ast.dump(node))

    try:
        return of(ast.parse(given.replace("^", "**"), mode="eval").body)
    except (KeyError, SyntaxError, ValueError, ZeroDivisionError) as fault:
        raise Refused(f"the expression {given!r}: {fault}") from None


def tables_of(path, depth=8):
    """A machine file over those that it extends."""
    try:
        import tomllib
    except ImportError:
        raise Refused("machine files are read with Python 3.11 or newer") from None

    if depth == 0 or not path.is_file():
        raise Refused(f"{path}: the file that is extended is not beside it")
    own = tomllib.loads(path.read_text(encoding="utf-8"))
    if "extends" not in own:
        return own
    name = own["extends"]
    under = tables_of(path.parent / (name if name.endswith(".toml") else f"{name}.toml"), depth - 1)

    def over(below, above):
        if isinstance(below, dict) and isinstance(above, dict):
            return {key: over(below.get(key), above.get(key, below.get(key))) for key in {**below, **above}}
        return above

    return over(under, own)


def checked(command, path, shown=None):
    """What `post check` derives of a machine file, or why it is refused; messages name it as `shown`."""
    with tempfile.TemporaryDirectory() as scratch:
        result = Path(scratch) / "check.json"
        try:
            run = subprocess.run([command, "check", str(path), "--json", str(result)], capture_output=True, text=True)
        except OSError as fault:
            raise Refused(f"{command}: cannot be run ({fault.strerror}): --post names it") from None
        said = run.stderr.replace(str(path), str(shown or path))
        if run.returncode != 0:
            raise Refused(said.strip())
        print(said, end="", file=sys.stderr)
        return json.loads(result.read_text(encoding="utf-8"))
