"""What a design costs a coding agent: bytes into and out of each tool, over the whole path.

    python benchmarks/coding_agent.py [EXAMPLE] [--json FILE]

A client of the official SDK speaks with `articad mcp` over stdio and designs, builds, looks at, certifies and exports an example;
by default the wardrobe, whose 18 parts take eight scripts, as `benchmarks/products` states it in the short form. Pictures are counted apart: a model is
charged for their size in pixels. Exit code 1 if the text of the whole path exceeds a goal.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mcp import Client, StdioServerParameters
from mcp.client.stdio import stdio_client

from articad import examples
from articad.kernels.parts import script_file
from articad.plan.short import expanded

GOAL_SENT = 12_121  # bytes that a model writes: half of what the wardrobe took in the long form
GOAL_RECEIVED = 4_000  # bytes that it reads, besides the tools' own descriptions
PRODUCTS = Path(__file__).parent / "products"


@dataclass
class Row:
    """What went through one tool."""

    calls: int = 0
    sent: int = 0
    received: int = 0
    pictures: int = 0


class Counting:
    """A client that counts what goes in and out of each tool."""

    def __init__(self, client: Client) -> None:
        self._client = client
        self.rows: dict[str, Row] = {}

    async def call(self, tool: str, **arguments: Any) -> Any:
        """Call a tool and return what it answered; stop where it refuses."""
        answer = await self._client.call_tool(tool, arguments)
        texts = [content.text for content in answer.content if content.type == "text"]
        row = self.rows.setdefault(tool, Row())
        row.calls += 1
        row.sent += len(json.dumps(arguments, ensure_ascii=False).encode())
        row.received += sum(len(text.encode()) for text in texts)
        row.pictures += len(answer.content) - len(texts)
        if answer.is_error:
            sys.exit(f"{tool} refused: {texts}")
        return json.loads(texts[0]) if texts and texts[0].startswith("{") else texts


async def design(agent: Counting, name: str) -> None:
    """Go the whole path, with a mistake in the plan on the way."""
    folder = PRODUCTS / name if (PRODUCTS / name).is_dir() else examples.folder(name)
    plan = json.loads((folder / "plan.json").read_text())
    await agent.call("check_plan", design="mine", plan={**plan, "freedoms": plan["freedoms"] + 1})
    await agent.call("explain", code="E_DOF_MISMATCH")
    await agent.call("edit_plan", design="mine", changes={"freedoms": plan["freedoms"]})
    await agent.call("docs", dialect="build123d", intent="round the vertical edges")
    for part in expanded(plan)["parts"]:
        if "derive" not in part:
            script = script_file(folder / "parts", part["name"], "build123d").read_text()
            await agent.call("build_part", design="mine", part=part["name"], script=script)
    built = await agent.call("build", design="mine")
    await agent.call("render", design="mine")
    await agent.call("certify", design="mine", joints=[built["drivers"][0]["name"]], pairs=False, budget_s=900)
    await agent.call("sim", design="mine")
    await agent.call("audit", design="mine")
    await agent.call("export", design="mine", formats=["mjcf", "step", "glb"])
    parameter = next((each for each in expanded(plan).get("parameters", []) if isinstance(each["value"], int | float)), None)
    if parameter:
        await agent.call("edit_parameters", design="mine", values={parameter["name"]: parameter["value"] * 1.001})


async def measured(name: str, root: Path) -> tuple[dict[str, Row], int]:
    """Return what went through each tool, and the size of the tools' own descriptions."""
    server = StdioServerParameters(command=sys.executable, args=["-m", "articad.cli", "mcp", "--root", str(root)])
    async with Client(stdio_client(server)) as client:
        tools = (await client.list_tools()).tools
        described = len(json.dumps([tool.model_dump(mode="json", exclude_none=True) for tool in tools]).encode())
        agent = Counting(client)
        await design(agent, name)
    return agent.rows, described


def main() -> int:
    """Measure, print and return the exit code."""
    reader = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    reader.add_argument("example", nargs="?", default="wardrobe")
    reader.add_argument("--json", type=Path)
    arguments = reader.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        rows, described = asyncio.run(measured(arguments.example, Path(scratch)))
    print(f"{'tool':<16}{'calls':>6}{'bytes in':>10}{'bytes out':>11}{'pictures':>10}")
    for tool, row in rows.items():
        print(f"{tool:<16}{row.calls:>6}{row.sent:>10}{row.received:>11}{row.pictures:>10}")
    sent, received = sum(row.sent for row in rows.values()), sum(row.received for row in rows.values())
    print(f"{'together':<16}{sum(row.calls for row in rows.values()):>6}{sent:>10}{received:>11}")
    print(f"the tools' own descriptions: {described} bytes, once")
    if arguments.json:
        arguments.json.write_text(json.dumps({tool: vars(row) for tool, row in rows.items()}, indent=1))
    met = sent <= GOAL_SENT and received <= GOAL_RECEIVED
    print(f"in {sent} of at most {GOAL_SENT}, out {received} of at most {GOAL_RECEIVED}: {'met' if met else 'missed'}")
    return 0 if met else 1


if __name__ == "__main__":
    sys.exit(main())
