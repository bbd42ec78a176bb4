"""Run folders: what was asked, built, checked and written; their record; plan folders made from foreign files."""
