"""Run folders: the request, the built parts, the checks and the exports of a run; plan folders made from foreign files."""
