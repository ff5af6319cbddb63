"""What is said on a page of Markdown, taken apart: tables, headings, commands, numbers."""

import re

FENCE = re.compile(r"^(```|~~~)[^\n]*\n.*?^\1[ \t]*$", re.DOTALL | re.MULTILINE)
MEASURED = re.compile(
    r"(?<![\w.])\d[\d.,]*(?:e-?\d+)?(?: |\u00a0)?"
    r"(?:ms|µs|ns|s|min|minutes|seconds|hours|GB/s|MB|kB|GB|GFlop/s|M/s|M springs/s|%|times (?:as|the)|times)(?![\w/])"
)


def without_code(text):
    """The text without code blocks, code in lines, and comments."""
    text = re.sub(r"<!--.*?-->", "", FENCE.sub("", text), flags=re.DOTALL)
    return re.sub(r"`[^`\n]*`", "CODE", text)


def table_heads(text):
    """The cells of the head of each table."""
    lines = FENCE.sub("", text).splitlines()
    return [
        [cell.strip() for cell in head.strip().strip("|").split("|")]
        for head, rule in zip(lines, lines[1:])
        if re.match(r"\s*\|[\s:|-]+\|\s*$", rule) and "|" in head
    ]


def anchors(text):
    """The names of a page's headings in links, as GitHub and Sphinx make them."""
    heads = re.findall(r"^#+ (.*)$", FENCE.sub("", text), re.MULTILINE)
    return {re.sub(r"\s", "-", re.sub(r"[^\w\s-]", "", head.strip().lower())) for head in heads}


def commands(block):
    """The commands of a block of shell: continued lines joined, comments and prompts left out."""
    lines = re.sub(r"\\\n\s*", "", block).splitlines()
    found = [re.sub(r"(^|\s)#.*$", "", line).strip().removeprefix("$ ") for line in lines]
    return [line for line in found if line]


def typed_numbers(template):
    """The measured-looking numbers that a template types, each with its line's number: those with a
    unit of time, memory, speed, or a ratio. A line that ends in {# chosen #} has chosen ones."""
    template = FENCE.sub(lambda block: "\n" * block[0].count("\n"), template)
    template = re.sub(
        r"\{\{.*?\}\}|\{%.*?%\}", lambda code: "\n" * code[0].count("\n"), template, flags=re.DOTALL
    )
    found = []
    for number, line in enumerate(template.splitlines(), 1):
        if "{# chosen #}" in line:
            continue
        bare = re.sub(r"`[^`]*`|\([^)\s]*\)", "", line)
        found += [(number, match[0]) for match in MEASURED.finditer(bare)]
    return found
