//! A report as PDF: A4 pages with text that can be searched and copied, drawings as lines, the type embedded, the chapters as
//! bookmarks.

mod deflate;
mod drawn;
mod face;
mod front_page;
mod paper;

use super::front::Front;
use super::logo::Logo;
use super::page::Part;
use deflate::compressed;
use face::{FACE, Face, FontError};
use front_page::LOGO;
use paper::{HEIGHT, Paper, WIDTH, footers};
use pdf_writer::{Content, Filter, Pdf, Rect, Ref, TextStr};

/// Number, title and page of a chapter.
type Chapter = (usize, String, usize);

/// The logo: after catalogue, tree of pages, information and the five objects of the face.
const LOGO_OBJECT: i32 = 9;
/// The first page.
const FIRST_PAGE: i32 = 10;

/// The whole file.
///
/// # Errors
/// [`FontError`]: the face that is built in cannot be read.
pub(super) fn document(front: &Front, parts: &[Part]) -> Result<Vec<u8>, FontError> {
    let face = Face::built_in()?;
    let mut paper = Paper::new(&face);
    for (k, part) in parts.iter().enumerate() {
        paper.part(part, parts.get(k + 1));
    }
    let (body, chapters) = paper.finish();
    // The contents are as long whatever the numbers in them are.
    let before = title_page(&face, front, &chapters, 0).len();
    let mut pages = title_page(&face, front, &chapters, before);
    pages.extend(body);
    footers(&face, &front.title, &mut pages);
    let chapters: Vec<Chapter> = chapters.into_iter().map(|(k, title, page)| (k, title, page + before)).collect();
    Ok(assembled(front, &face, pages, &chapters))
}

/// The title page where the body begins after `before` pages.
fn title_page(face: &Face, front: &Front, chapters: &[Chapter], before: usize) -> Vec<Content> {
    let contents: Vec<Chapter> =
        chapters.iter().map(|(k, title, page)| (*k, title.clone(), page + before + 1)).collect();
    let mut paper = Paper::new(face);
    front_page::draw(&mut paper, front, &contents);
    paper.finish().0
}

fn assembled(front: &Front, face: &Face, pages: Vec<Content>, chapters: &[Chapter]) -> Vec<u8> {
    let mut pdf = Pdf::new();
    let [catalogue, tree, information, logo] = [1, 2, 3, LOGO_OBJECT].map(Ref::new);
    let page = |k: usize| Ref::new(FIRST_PAGE + 2 * k as i32);
    let outline = page(pages.len());
    pdf.catalog(catalogue).pages(tree).outlines(outline);
    pdf.pages(tree).kids((0..pages.len()).map(page)).count(pages.len() as i32);
    let mut about = pdf.document_info(information);
    about.title(TextStr(&front.title));
    about.producer(TextStr(concat!("Dashpot ", env!("CARGO_PKG_VERSION"))));
    drop(about);
    let font = face.embed(&mut pdf, 4);
    if let Some(picture) = &front.logo {
        image(&mut pdf, logo, picture);
    }
    bookmarks(&mut pdf, outline, chapters, page);
    for (k, content) in pages.into_iter().enumerate() {
        let marks = Ref::new(page(k).get() + 1);
        let mut own = pdf.page(page(k));
        own.parent(tree).media_box(Rect::new(0.0, 0.0, WIDTH, HEIGHT)).contents(marks);
        let mut resources = own.resources();
        resources.fonts().pair(FACE, font);
        if front.logo.is_some() {
            resources.x_objects().pair(LOGO, logo);
        }
        drop(resources);
        drop(own);
        let bytes = compressed(content.finish().as_slice());
        pdf.stream(marks, &bytes).filter(Filter::FlateDecode);
    }
    pdf.finish()
}

fn image(pdf: &mut Pdf, object: Ref, logo: &Logo) {
    let bytes = compressed(&logo.rgb);
    let mut image = pdf.image_xobject(object, &bytes);
    let [width, height] = logo.size.map(|v| v as i32);
    image.filter(Filter::FlateDecode);
    image.width(width).height(height).bits_per_component(8);
    image.color_space().device_rgb();
}

/// The chapters at the side of the pages: the list at `outline`, its entries in the objects after it.
fn bookmarks(pdf: &mut Pdf, outline: Ref, chapters: &[Chapter], page: impl Fn(usize) -> Ref) {
    let entry = |k: usize| Ref::new(outline.get() + 1 + k as i32);
    let mut list = pdf.outline(outline);
    if !chapters.is_empty() {
        list.first(entry(0)).last(entry(chapters.len() - 1)).count(chapters.len() as i32);
    }
    drop(list);
    for (k, (number, title, at)) in chapters.iter().enumerate() {
        let mut item = pdf.outline_item(entry(k));
        item.title(TextStr(&format!("{number}  {title}"))).parent(outline);
        if k > 0 {
            item.prev(entry(k - 1));
        }
        if k + 1 < chapters.len() {
            item.next(entry(k + 1));
        }
        item.dest().page(page(*at)).fit();
    }
}

#[cfg(test)]
mod tests;
