//! A reader of uncompressed MATLAB level 5 files, written from the specification and independent of the writer.

use faer::Mat;
use std::collections::BTreeMap;

#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Value {
    Numbers(Mat<f64>),
    Text(String),
    Cells(Vec<Value>),
    Structs(Vec<BTreeMap<String, Value>>),
}

impl Value {
    pub(crate) fn numbers(&self) -> &Mat<f64> {
        let Self::Numbers(m) = self else { panic!("{self:?} is no matrix of numbers") };
        m
    }

    pub(crate) fn text(&self) -> &str {
        let Self::Text(t) = self else { panic!("{self:?} is no text") };
        t
    }
}

struct Cursor<'a>(&'a [u8]);

impl<'a> Cursor<'a> {
    fn take(&mut self, n: usize) -> &'a [u8] {
        let (head, tail) = self.0.split_at(n);
        self.0 = tail;
        head
    }

    fn u32(&mut self) -> u32 {
        u32::from_le_bytes(self.take(4).try_into().unwrap())
    }

    /// Type and data of the next element, in its normal or its small form.
    fn element(&mut self) -> (u32, &'a [u8]) {
        let tag = self.u32();
        if tag >> 16 != 0 {
            let data = self.take(4);
            return (tag & 0xffff, &data[..(tag >> 16) as usize]);
        }
        let length = self.u32() as usize;
        let data = self.take(length);
        self.take(length.next_multiple_of(8) - length);
        (tag, data)
    }
}

fn words(data: &[u8]) -> Vec<usize> {
    data.chunks(4).map(|b| u32::from_le_bytes(b.try_into().unwrap()) as usize).collect()
}

fn array(data: &[u8]) -> (String, Value) {
    let mut cursor = Cursor(data);
    let class = words(cursor.element().1)[0] & 0xff;
    let size = words(cursor.element().1);
    let name = String::from_utf8(cursor.element().1.to_vec()).unwrap();
    let count: usize = size.iter().product();
    let value = match class {
        6 => {
            let (kind, data) = cursor.element();
            assert_eq!(kind, 9);
            let numbers: Vec<f64> = data.chunks(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect();
            Value::Numbers(Mat::from_fn(size[0], size[1], |i, j| numbers[j * size[0] + i]))
        }
        4 => {
            let (kind, data) = cursor.element();
            assert_eq!(kind, 4);
            let units: Vec<u16> = data.chunks(2).map(|b| u16::from_le_bytes(b.try_into().unwrap())).collect();
            assert_eq!(units.len(), count);
            Value::Text(String::from_utf16(&units).unwrap())
        }
        1 => Value::Cells((0..count).map(|_| array(cursor.element().1).1).collect()),
        2 => {
            let length = words(cursor.element().1)[0];
            let fields: Vec<String> = cursor
                .element()
                .1
                .chunks(length)
                .map(|b| String::from_utf8(b.iter().copied().take_while(|&c| c != 0).collect()).unwrap())
                .collect();
            let named_fields =
                |cursor: &mut Cursor| fields.iter().map(|f| (f.clone(), array(cursor.element().1).1)).collect();
            Value::Structs((0..count).map(|_| named_fields(&mut cursor)).collect())
        }
        other => panic!("class {other}"),
    };
    assert!(cursor.0.is_empty(), "{} bytes are left after {name}", cursor.0.len());
    (name, value)
}

pub(crate) fn read(bytes: &[u8]) -> BTreeMap<String, Value> {
    assert_eq!(&bytes[124..128], [0x00, 0x01, b'I', b'M']);
    let mut cursor = Cursor(&bytes[128..]);
    let mut variables = BTreeMap::new();
    while !cursor.0.is_empty() {
        let (kind, data) = cursor.element();
        assert_eq!(kind, 14);
        variables.extend([array(data)]);
    }
    variables
}
